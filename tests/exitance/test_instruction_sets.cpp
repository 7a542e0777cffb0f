// SPDX-License-Identifier: GPL-3.0-or-later
// One answer from every instruction set.
#include "core/parallel.h"
#include "exitance/simd/lane_kernels.h"
#include "opaline/error.h"
#include "support/clouds.h"

namespace opaline {
namespace {

using namespace test;

struct NamedSet {
  const char* name;
  InstructionSet set;
  const LaneKernels* kernels;
};
constexpr std::array kSets = {NamedSet{"avx2", InstructionSet::avx2, &kAvx2Kernels},
                              NamedSet{"avx512", InstructionSet::avx512, &kAvx512Kernels}};

bool has(InstructionSet set) {
  return set == InstructionSet::avx512 ? this_machine().avx512 : this_machine().avx2;
}

// Claim: exitance, irradiance and error agree between the baseline and each set that the machine has, a plate
// thinner than h and a coloured torus, both profiles, with and without split. Source: lane_kernels.h: the
// same operations but for the rounding of a b + c. Tolerance: 1e-5 relative to max(value, 1e-3 of the
// largest). Fails if: the bits of a block of lanes are not shifted into place.
TEST(InstructionSets, Agree) {
  const std::vector<ShapeSource> shapes = {TorusShape{{}, 10, 4}, SlabShape{{}, 20, 20, .1}};
  for (const ShapeSource& shape : shapes) {
    const Cloud cloud(shape, 10000);
    const std::vector<Query> queries = Cloud(shape, 1000, 3).queries();
    const Octree octree = cloud.tree(coloured_light);
    for (const ProfileKind kind : {ProfileKind::dipole, ProfileKind::normalized_diffusion})
      for (const bool split : {true, false}) {
        const SplitKernel kernel = cloud.kernel(
            make_diffuse_profile({"m", PhysicalMedium{{.001, .1, 2}, {2, 3, 4}}, 1.4, kind}), split);
        const auto run = [&](InstructionSet set) {
          EvaluateInput input{octree, kernel, queries};
          input.instruction_set = set;
          return evaluate(input);
        };
        const std::vector<Exitance> baseline = run(InstructionSet::baseline);
        RgbF largest;
        for (const Exitance& e : baseline) largest = component_max(largest, e.exitance);
        for (const NamedSet& named : kSets) {
          if (!has(named.set)) continue;
          double apart = 0;
          const std::vector<Exitance> values = run(named.set);
          for (std::size_t i = 0; i < values.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c) {
              const double m = double(baseline[i].exitance[c]),
                           scale = std::max(m, 1e-3 * double(largest[c]));
              apart = std::max(apart, std::abs(double(values[i].exitance[c]) - m) / scale);
              ASSERT_NEAR(values[i].irradiance[c], baseline[i].irradiance[c], 1e-5) << named.name;
              ASSERT_NEAR(values[i].error[c], baseline[i].error[c], 1e-4 * double(largest[c])) << named.name;
            }
          EXPECT_LE(apart, 1e-5) << named.name << " split " << split;
          report(std::string(named.name) + " from baseline, largest", apart);
        }
      }
  }
}

// Claim: the loops themselves agree on lists of nodes and of leaves, per channel and lane, and note the same
// samples of other sheets for the same lanes. Source: lane_kernels.h. Tolerance: 1e-5 of the sum; none for
// the notes. Fails if: a block's bits are not shifted into place.
TEST(InstructionSets, LoopsAgree) {
  const FlushDenormals mode;
  const Cloud cloud(SlabShape{{}, 20, 20, .1}, 4000);
  const Octree octree = cloud.tree(coloured_light);
  const SplitKernel kernel = cloud.kernel(make_diffuse_profile(marble()));
  const LaneInput input{*kernel.lanes, octree.nodes.data(), octree.samples.data(), octree.normals.data(),
                        kernel.radius * kernel.radius};
  std::vector<std::uint32_t> leaves;
  std::size_t samples = 0;
  for (std::uint32_t i = 0; i < octree.nodes.size(); ++i)
    if (octree.nodes[i].leaf) leaves.push_back(i), samples += octree.nodes[i].count;
  Packet packet{};
  for (std::size_t i = 0; i < kLanes; ++i) {
    const SurfaceSample& s = cloud.surface.samples[i * 37];
    packet.x[i] = s.position.x, packet.y[i] = s.position.y, packet.z[i] = s.position.z;
    packet.nx[i] = s.normal.x, packet.ny[i] = s.normal.y, packet.nz[i] = s.normal.z;
  }
  struct Result {
    PacketSums nodes{}, leaves{};
    std::vector<std::pair<std::uint32_t, std::uint32_t>> whole;  // sample, lane
  };
  const auto run = [&](const LaneKernels& kernels) {
    Result r;
    kernels.add_nodes(input, leaves.data(), leaves.size(), packet, r.nodes);
    std::vector<std::uint32_t> room(samples * kLanes);
    auto* whole = reinterpret_cast<std::uint32_t(*)[2]>(room.data());
    const std::size_t n = kernels.add_leaves(input, leaves.data(), leaves.size(), packet, r.leaves, whole);
    for (std::size_t i = 0; i < n; ++i)
      for (std::uint32_t lane = 0; lane < kLanes; ++lane)
        if (whole[i][1] >> lane & 1) r.whole.emplace_back(whole[i][0], lane);
    std::ranges::sort(r.whole);
    return r;
  };
  const Result baseline = run(kBaselineKernels);
  EXPECT_GT(baseline.whole.size(), 100u);
  for (const NamedSet& named : kSets) {
    if (!has(named.set)) continue;
    const Result r = run(*named.kernels);
    EXPECT_EQ(r.whole, baseline.whole) << named.name;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        EXPECT_NEAR(r.nodes.exitance[c][lane] / baseline.nodes.exitance[c][lane], 1, 1e-5) << named.name;
        EXPECT_NEAR(r.leaves.exitance[c][lane] / baseline.leaves.exitance[c][lane], 1, 1e-5) << named.name;
        EXPECT_NEAR(r.leaves.squares[c][lane] / baseline.leaves.squares[c][lane], 1, 1e-5) << named.name;
        EXPECT_NEAR(r.leaves.near_flux[c][lane] / baseline.leaves.near_flux[c][lane], 1, 1e-5) << named.name;
      }
  }
}

// Claim: a set that the machine has not got is refused by name as bad input; automatic takes the widest there
// is, and baseline always goes. Source: lane_kernels.h. Tolerance: none. Fails if: a missing set is taken all
// the same.
TEST(InstructionSets, MissingIsRefused) {
  const MachineSets none, avx2{true, false}, all{true, true};
  const auto refused = [](InstructionSet set, const MachineSets& machine) {
    try {
      lane_kernels(set, machine);
    } catch (const Error& e) {
      EXPECT_EQ(e.kind, ErrorKind::bad_input);
      EXPECT_NE(e.message.find("instruction_set"), std::string::npos);
      return e.got;
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refused(InstructionSet::avx2, none), "avx2");
  EXPECT_EQ(refused(InstructionSet::avx512, none), "avx512");
  EXPECT_EQ(refused(InstructionSet::avx512, avx2), "avx512");
  EXPECT_EQ(&lane_kernels(InstructionSet::automatic, none), &kBaselineKernels);
  EXPECT_EQ(&lane_kernels(InstructionSet::automatic, avx2), &kAvx2Kernels);
  EXPECT_EQ(&lane_kernels(InstructionSet::automatic, all), &kAvx512Kernels);
  for (const MachineSets& machine : {none, avx2, all})
    EXPECT_EQ(&lane_kernels(InstructionSet::baseline, machine), &kBaselineKernels);
  EXPECT_EQ(&lane_kernels(InstructionSet::avx2, all), &kAvx2Kernels);
  EXPECT_EQ(&lane_kernels(InstructionSet::avx512, all), &kAvx512Kernels);
}

// Claim: evaluate itself refuses a set that this machine has not got, before it computes anything. Source:
// evaluate.h. Tolerance: none. Fails if: the error is lost in a worker thread.
TEST(InstructionSets, EvaluateRefusesToo) {
  const Cloud cloud(SphereShape{{}, 5}, 200);
  const SplitKernel kernel = cloud.kernel(make_diffuse_profile(marble()));
  const Octree octree = cloud.tree(RgbF(1));
  const std::vector<Query> queries = cloud.queries();
  for (const NamedSet& named : kSets) {
    EvaluateInput input{octree, kernel, queries};
    input.instruction_set = named.set;
    if (has(named.set)) {
      EXPECT_EQ(evaluate(input).size(), queries.size());
    } else {
      EXPECT_THROW(evaluate(input), Error);
    }
  }
}

}  // namespace
}  // namespace opaline
