// SPDX-License-Identifier: GPL-3.0-or-later
// What the machine has left for the process: the least of all that can stop it.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>

#include "core/machine_memory.h"
#include "scratch_folder.h"

namespace opaline {
namespace {

/// A machine's files under a folder of their own.
class FakeMachine {
 public:
  void put(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(root() + path).parent_path());
    put_bytes(root() + path, text);
  }
  std::string root() const { return folder_.file("machine"); }

 private:
  ScratchFolder folder_;
};

constexpr const char* kMeminfo = "MemTotal:       4000 kB\nMemFree: 10 kB\nMemAvailable:   3000 kB\n";

// Claim: without control groups it is MemAvailable, in kB; without any of these files nothing is known and
// nothing is refused. Source: proc(5). Tolerance: none. Fails if: MemFree is taken, or kB for bytes.
TEST(MachineMemory, IsWhatTheKernelCountsAsAvailable) {
  const FakeMachine machine;
  EXPECT_EQ(available_memory(machine.root()), std::numeric_limits<std::size_t>::max());
  machine.put("/proc/meminfo", kMeminfo);
  EXPECT_EQ(available_memory(machine.root()), 3000u * 1024);
}

// Claim: a control group of version 2, or any group above it, leaves its limit less what is used, and file
// pages that can be dropped are not used; "max" is no limit. Source: the kernel's cgroup-v2 document.
// Tolerance: none. Fails if: only the innermost group is read, or memory.current is taken as it is.
TEST(MachineMemory, AnyControlGroupAboveLimitsIt) {
  const FakeMachine machine;
  machine.put("/proc/meminfo", kMeminfo);
  machine.put("/proc/self/cgroup", "0::/slice/job\n");
  machine.put("/sys/fs/cgroup/slice/job/memory.max", "max\n");
  machine.put("/sys/fs/cgroup/slice/job/memory.current", "500\n");
  machine.put("/sys/fs/cgroup/slice/memory.max", "1000000\n");
  machine.put("/sys/fs/cgroup/slice/memory.current", "700000\n");
  machine.put("/sys/fs/cgroup/slice/memory.stat", "anon 1\ninactive_file 200000\n");
  EXPECT_EQ(available_memory(machine.root()), 500000u);
}

// Claim: so does one of version 1; inside a container, whose path is not mounted, the mount itself is the
// group. Source: the kernel's cgroup-v1 memory document. Tolerance: none. Fails if: the path must exist.
TEST(MachineMemory, AContainerOfVersion1LimitsIt) {
  const FakeMachine machine;
  machine.put("/proc/meminfo", kMeminfo);
  machine.put("/proc/self/cgroup", "5:cpu:/\n4:memory:/docker/abc\n");
  machine.put("/sys/fs/cgroup/memory/memory.limit_in_bytes", "90000\n");
  machine.put("/sys/fs/cgroup/memory/memory.usage_in_bytes", "100000\n");
  EXPECT_EQ(available_memory(machine.root()), 0u);
  machine.put("/sys/fs/cgroup/memory/memory.stat", "total_inactive_file 40000\n");
  EXPECT_EQ(available_memory(machine.root()), 30000u);
}

// Claim: a limit of the address space counts, less what of it is taken. Source: getrlimit(2). Tolerance: a
// limit that is higher by a part leaves that part more, but for what the heap grew by between. Fails if: only
// /proc is read.
TEST(MachineMemory, AnAddressSpaceLimitCounts) {
  const FakeMachine machine;
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  const auto left_of = [&](rlim_t limit) {
    const rlimit lower{limit, before.rlim_max};
    EXPECT_EQ(setrlimit(RLIMIT_AS, &lower), 0);
    return available_memory(machine.root());
  };
  const rlim_t high = std::min(before.rlim_max, rlim_t(1) << 46), step = high / 64;
  const std::size_t less = left_of(high - step), more = left_of(high);
  ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
  EXPECT_NEAR(double(more - less), double(step), 1e7);
  EXPECT_GT(resident_memory(), 1u << 20);
}

}  // namespace
}  // namespace opaline
