// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <iostream>

#include "asset_test.h"
#include "geometry/world.h"

namespace opaline::asset_test {
namespace {

// Claim: each of the assets that Debian's assimp-testmodels has, many of them broken on purpose, becomes a scene whose
// meshes can be read, or is refused as bad input with the file's name in front. Fails if one crashes, hangs, or throws
// something else.
TEST(LongModels, AreUnderstoodOrRefusedByName) {
  const std::filesystem::path folder = "/usr/share/assimp/models";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "needs the package assimp-testmodels";
  std::size_t understood = 0, refused = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string path = entry.path().string();
    if (!entry.is_regular_file() || !is_asset_name(path)) continue;
    try {
      make_world(load_scene(path));
      ++understood;
    } catch (const Error& failure) {
      EXPECT_EQ(failure.kind, ErrorKind::bad_input) << failure.what();
      EXPECT_TRUE(std::string(failure.what()).starts_with(path)) << failure.what();
      std::cout << failure.what() << '\n';
      ++refused;
    }
  }
  std::cout << understood << " understood, " << refused << " refused\n";
  EXPECT_GT(understood, 30u);
}

}  // namespace
}  // namespace opaline::asset_test
