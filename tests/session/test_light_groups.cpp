// SPDX-License-Identifier: GPL-3.0-or-later
// What each light adds to a picture, as layers.
#include "lights/light.h"
#include "opaline/error.h"
#include "session/light_groups.h"
#include "session_test.h"

namespace opaline {
namespace {

using namespace test;

constexpr const char* kChannels[] = {"R", "G", "B"};

struct Grouped {
  Image plain, picture;
  explicit Grouped(const Scene& scene) {
    Session session;
    session.edit(scene);
    plain = session.render().image;
    picture = plain;
    add_light_groups(session, picture);
  }
};

/// Sum of a picture's groups over R, G or B, the largest difference, relative to the brightest pixel and to each.
void expect_sum(const Scene& scene, const Image& picture) {
  const std::vector<LightGroup> groups = light_groups(scene);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (const std::string c : kChannels) {
        float sum = 0;
        for (const LightGroup& group : groups) {
          sum += channel(picture, x, y, "diffuse_" + group.layer + '.' + c);
          sum += channel(picture, x, y, "specular_" + group.layer + '.' + c);
          if (group.is_seen) sum += channel(picture, x, y, "emission_" + group.layer + '.' + c);
        }
        const float whole = channel(picture, x, y, c);
        EXPECT_NEAR(sum, whole, 3e-6f * whole) << x << ' ' << y << ' ' << c;
      }
}

/// Of what one light adds from the picture of the scene in which the others are black, over its mean.
struct Difference {
  double mean = 0, largest = 0;
};
Difference difference_alone(const Scene& scene, const Image& picture, std::size_t light) {
  Scene alone = scene;
  for (std::size_t l = 0; l < scene.lights.size(); ++l)
    if (l != light) alone.lights[l] = with_emission(alone.lights[l], {});
  const Image wanted = cold_picture(alone);
  double most = 0, sum = 0, whole = 0;
  int count = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (const std::string c : kChannels)
        for (const std::string kind : {"diffuse", "specular"}) {
          const double value =
                           double(channel(picture, x, y, kind + '_' + scene.lights[light].name + '.' + c)),
                       alone_value = double(channel(wanted, x, y, kind + '.' + c));
          most = std::max(most, std::abs(value - alone_value));
          sum += std::abs(value - alone_value);
          whole += alone_value;
          if (alone_value > 0) ++count;
        }
  return {sum / whole, most * count / whole};
}

/// Lights of all kinds that may be seen, and a glossy floor.
Scene lit_balls() {
  Scene scene = two_balls();
  scene.lights.push_back({"surroundings", Surroundings{{.02, .03, .05}}});
  scene.lights[1] = {"panel", QuadLight{{-20, 40, -30}, {40, 0, 0}, {0, -20, 0}, {5, 6, 7}}};
  scene.shapes[2].gloss = Gloss{.metalness = .3, .roughness = .3};
  scene.film.samples_per_pixel = 4;
  return scene;
}

// Claim: the groups sum to the picture, lights that are seen included; each is the picture by its light alone; and the
// other layers are the bytes that they are without groups. Source: light_groups.h. Tolerance: a mean of .3 %, below the
// evaluator's .5 %; a pixel 15 % of the mean (beside edges of a brighter light's shadow its noise is shared, 2 % of the
// light's brightest pixel measured). Fails if a light is left out, what is seen of it is, a group has another light's
// picture, or the picture is replaced by the sum.
TEST(LightGroups, SumToThePicture) {
  for (const EvaluatorKind evaluator : {EvaluatorKind::dual_tree, EvaluatorKind::surface_cache}) {
    Scene scene = lit_balls();
    scene.settings.evaluator = evaluator;
    const Grouped grouped(scene);
    expect_sum(scene, grouped.picture);
    for (std::size_t light = 0; light < scene.lights.size(); ++light) {
      const Difference difference = difference_alone(scene, grouped.picture, light);
      EXPECT_LT(difference.mean, .003) << light;
      EXPECT_LT(difference.largest, .15) << light;
    }
    for (int y = 0; y < grouped.plain.height; ++y)
      for (int x = 0; x < grouped.plain.width; ++x)
        for (const std::string& name : grouped.plain.channels)
          EXPECT_EQ(channel(grouped.picture, x, y, name), channel(grouped.plain, x, y, name));
  }
}

// Claim: the backdrop is a layer of its own, the only one where no shape is seen. Source: light_groups.h. Fails if: it is in the
// layer of a light, too, or in none.
TEST(LightGroups, BackdropIsALayer) {
  Scene scene = lit_balls();
  scene.backdrop = Rgb{.1, .2, .4};
  const Grouped grouped(scene);
  expect_sum(scene, grouped.picture);
  EXPECT_EQ(light_groups(scene).back().layer, "backdrop");
  int seen = 0;
  for (int x = 0; x < grouped.picture.width; ++x)
    if (channel(grouped.picture, x, 0, "A") == 0) {
      EXPECT_EQ(channel(grouped.picture, x, 0, "emission_backdrop.B"), .4f);
      EXPECT_EQ(channel(grouped.picture, x, 0, "emission_surroundings.B"), 0);
      ++seen;
    }
  EXPECT_GT(seen, 0);
  scene.lights[0].name = "backdrop";
  EXPECT_THROW(light_groups(scene), Error);
}

// Claim: light that bounces is in the group of the light that it comes from, with all methods that have groups. Fails if groups are rendered without bounces, or bounced light is kept from the light
// before.
TEST(LightGroups, BouncedLightAndOtherMethods) {
  for (const Method method : {Method::hierarchical, Method::lambert, Method::volume_diffusion}) {
    Scene scene = lit_balls();
    scene.settings.method = method;
    scene.settings.bounces = 1;
    const Grouped grouped(scene);
    expect_sum(scene, grouped.picture);
    for (const std::size_t light : {0, 1})
      EXPECT_LT(difference_alone(scene, grouped.picture, light).mean, .003) << light;
  }
}

// Claim: one light is the picture itself, and the channels of one environment are one light. Fails if the group is
// empty, or three groups have one name.
TEST(LightGroups, OneLight) {
  Scene scene = two_balls();
  scene.lights.resize(1);
  const Grouped grouped(scene);
  for (const std::string c : kChannels) {
    EXPECT_EQ(channel(grouped.picture, 20, 16, "diffuse_key." + c),
              channel(grouped.plain, 20, 16, "diffuse." + c));
    EXPECT_GT(channel(grouped.picture, 17, 16, "diffuse_key." + c), 0);
  }
  scene.lights = {{"room", PointLight{}}, {"room", PointLight{}}, {"sun", DirectionalLight{}}};
  ASSERT_EQ(light_groups(scene).size(), 2u);
  EXPECT_EQ(light_groups(scene)[0].lights, (std::vector<std::size_t>{0, 1}));
}

// Claim: afterwards the session is as it was: the same picture, and nothing to compute for it but shading. Fails if it
// is left with one light.
TEST(LightGroups, SessionIsAsItWas) {
  const Scene scene = two_balls();
  Session session;
  session.edit(scene);
  const Image before = session.render().image;
  Image grouped = before;
  add_light_groups(session, grouped);
  EXPECT_EQ(session.scene(), scene);
  EXPECT_TRUE(same_pixels(session.render().image, before));
}

// Claim: layers have names of letters, digits and "_"; two lights of one such name, methods of other noise for each
// light, and a scene without lights are refused with words. Source: light_groups.h. Fails if one light's layer hides
// the other's.
TEST(LightGroups, NamesAndRefusals) {
  Scene scene = two_balls();
  scene.lights[0].name = "key.left 2";
  EXPECT_EQ(light_groups(scene)[0].layer, "key_left_2");
  const auto refusal = [](const Scene& refused) {
    try {
      light_groups(refused);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  scene.lights[1].name = "key-left 2";
  scene.lights[1].place = {"balls.json", 7, 3};
  EXPECT_EQ(
      refusal(scene).find("balls.json:7:3: light groups: two lights have the same layer \"key_left_2\""), 0u)
      << refusal(scene);
  scene = two_balls();
  for (const Method method : {Method::direct, Method::volume}) {
    scene.settings.method = method;
    EXPECT_NE(refusal(scene).find("volume_diffusion"), std::string::npos) << refusal(scene);
  }
  scene = two_balls();
  scene.lights.clear();
  EXPECT_NE(refusal(scene).find("no lights"), std::string::npos) << refusal(scene);
}

}  // namespace
}  // namespace opaline
