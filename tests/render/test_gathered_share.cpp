// SPDX-License-Identifier: GPL-3.0-or-later
// The share of gathered rays meeting a surface, as planned.
#include <gtest/gtest.h>

#include "input/load_scene.h"
#include "plan/gathered_share.h"

namespace opaline {
namespace {

double share_of(const std::string& shapes) {
  const Scene scene =
      parse_scene(R"({"media": {"m": {"preset": "marble"}}, "shapes": [)" + shapes + "]}", "share.json", {});
  return gathered_share(scene, make_world(scene));
}

// Claim: two square plates at a distance of their side exchange the form factor of .1998 of their facing sides. Source:
// Siegel & Howell, form factor of aligned parallel squares. Tolerance: .02, by 1,500 rays. Fails if: rays do not follow the
// cosine, or the boxes are in another space than the mesh.
TEST(GatheredShare, FacingSquares) {
  const auto plate = [](double y) {
    return R"({"slab": {"center": [400, )" + std::to_string(y) +
           R"(, 0], "width": 20, "depth": 20, "thickness": 0.001}, "medium": "m"})";
  };
  EXPECT_NEAR(share_of(plate(0) + "," + plate(20)), .1998 / 2, .02);
}

// Claim: a convex shape alone has none, a torus some; a shape in another one's box has nearly all. Source: the geometry. Fails
// if: a shape meets its own box.
TEST(GatheredShare, AloneAndEnclosed) {
  EXPECT_EQ(share_of(R"({"sphere": {"radius": 10}, "medium": "m"})"), 0);
  EXPECT_GT(share_of(R"({"torus": {"major_radius": 10, "minor_radius": 4}, "medium": "m"})"), .2);
  EXPECT_GT(share_of(R"({"sphere": {"radius": 1}, "medium": "m"},
                        {"torus": {"major_radius": 10, "minor_radius": 4}, "medium": "m"})"),
            .9);
}

}  // namespace
}  // namespace opaline
