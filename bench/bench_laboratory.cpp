// SPDX-License-Identifier: GPL-3.0-or-later
// Accuracy and cost of the laboratory: an isotropic half space at several albedos and boundaries.
//
//   bench_laboratory [WALKS]
//
// "worth" is how many walks that are counted as returned or not, each with the variance R (1 - R), one walk here
// replaces.
#include <fmt/format.h>

#include <cstdlib>

#include "transport/laboratory.h"
#include "user_seconds.h"

int main(int argc, char** argv) {
  using namespace opaline;
  const std::size_t walks = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 100000;
  fmt::print("{:>7}{:>6}{:>9}{:>11}{:>11}{:>9}{:>12}{:>10}{:>14}\n", "albedo", "eta", "entry", "returned",
             "error", "worth", "collisions", "us/walk", "ns/collision");
  for (const double eta : {1., 1.3, 1.5})
    for (const double albedo : {.2, .5, .9, .99, .999, .9999})
      for (const SlabEntry& entry : {kNormalEntry, kDiffuseEntry}) {
        LaboratorySettings settings;
        settings.walks = walks;
        SlabWalks walked;
        const double seconds = user_seconds([&] {
          walked = walk_slab({1 - albedo, albedo, 0, eta}, {}, entry, settings);
        });
        const double cost = seconds / double(walked.walks);
        const WalkedValue& r = walked.back.total;
        const double worth = r.value * (1 - r.value) / double(walked.walks) / (r.error * r.error);
        fmt::print("{:>7}{:>6}{:>9}{:>11.6f}{:>11.6f}{:>9.0f}{:>12.1f}{:>10.2f}{:>14.0f}\n", albedo, eta,
                   entry.is_diffuse ? "diffuse" : "normal", r.value, r.error, worth, walked.collisions,
                   1e6 * cost, 1e9 * cost / walked.collisions);
      }
}
