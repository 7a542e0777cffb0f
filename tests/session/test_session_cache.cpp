// SPDX-License-Identifier: GPL-3.0-or-later
// Sessions that share a cache.
#include "../core/scratch_folder.h"
#include "cache/cache_folder.h"
#include "session_test.h"
#include "stages/stage_codecs.h"
#include "stages/stage_keys.h"

namespace opaline {
namespace {

using namespace test;

// Claim: what one session computed another finds: it traces, places and builds nothing, and has the same
// picture, carried samples and edited lights included. Source: one notion of keys. Fails if: a result is kept
// under another key than it is looked for, or an input of it is in no key.
TEST(SessionCache, SecondComputesNothing) {
  const ScratchFolder folder;
  std::vector<Scene> scenes(4, two_balls());
  scenes[1].settings.bounces = 1;
  scenes[1].shapes[0].to_world = shifted({3, 1, 0});
  scenes[2].lights[0].source = PointLight{{9, 90, 0}, {1e4, 1e4, 1e4}};
  scenes[3].shapes.insert(scenes[3].shapes.begin(), scenes[3].shapes[2]);  // all mesh numbers move
  scenes[3].shapes[0].name = "second floor";
  std::vector<Image> pictures;
  for (int run = 0; run < 2; ++run) {
    StageCache cache(folder.path.string());
    Session session(&cache);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      const Image picture = picture_of(session, scenes[i]);
      if (run == 0) {
        pictures.push_back(picture);
        continue;
      }
      const SessionWork& work = session.work();
      EXPECT_EQ(work.samples_placed + work.samples_carried + work.nodes_built, 0u) << i;
      EXPECT_EQ(work.sample_rays, 0u) << i;
      EXPECT_GT(work.found, 0u) << i;
      EXPECT_TRUE(same_pixels(picture, pictures[i])) << i;
    }
    EXPECT_EQ(cache.warning(), "");
  }
  EXPECT_TRUE(same_pixels(pictures[2], cold_picture(scenes[2])));
  EXPECT_TRUE(same_pixels(pictures[3], cold_picture(scenes[3])));
}

// Claim: a surface cache made once is found by another session, which evaluates no place. Source: one notion
// of keys. Fails if: the key lacks the tree (the dimmed light's picture is the old one) or has the camera.
TEST(SessionCache, SurfaceCacheIsFound) {
  const ScratchFolder folder;
  Scene scene = two_balls();
  scene.settings.evaluator = EvaluatorKind::surface_cache;
  Scene turned = scene, dimmed = scene;
  turned.camera.position = {80, 20, 90};
  std::get<PointLight>(dimmed.lights[0].source).intensity = {1, 2e4, 9};
  for (const Scene* first : {&scene, &turned}) {
    StageCache cache(folder.path.string());
    Session session(&cache);
    EXPECT_TRUE(same_pixels(picture_of(session, *first), cold_picture(*first)));
    EXPECT_EQ(session.work().places_evaluated > 0, first == &scene);
    EXPECT_TRUE(same_pixels(picture_of(session, dimmed), cold_picture(dimmed)));
    EXPECT_EQ(session.work().places_evaluated > 0, first == &scene);
    EXPECT_EQ(cache.warning(), "");
  }
}

// Claim: diffusion is solved once, with light that bounced too: another session traces no ray from a sample and has the same
// picture; a floor of another colour sends other light. Source: one notion of keys. Fails if: what bounced is kept under the
// key of what the lights alone bring, or under one that does not know the floor.
TEST(SessionCache, DiffusionOfBouncedLightIsFound) {
  const ScratchFolder folder;
  Scene scene = two_balls();
  scene.settings.method = Method::volume_diffusion;
  scene.settings.bounces = 1;
  Scene lone = scene, red = scene;
  lone.settings.bounces = 0;
  red.shapes[2].reflectance = {.9, .1, .1};
  for (const bool is_first : {true, false}) {
    StageCache cache(folder.path.string());
    Session session(&cache);
    for (const Scene* each : {&scene, &lone, &red}) {
      EXPECT_TRUE(same_pixels(picture_of(session, *each), cold_picture(*each)));
      EXPECT_EQ(session.work().sample_rays > 0, is_first && each == &scene);
    }
    EXPECT_EQ(session.work().found, is_first ? 0u : 4u);  // bounced light of each ball, and its diffusion
    EXPECT_EQ(cache.warning(), "");
  }
  EXPECT_FALSE(same_pixels(cold_picture(scene), cold_picture(red)));
}

// Claim: it is found after an image without bounces, too, and the points of the image gather the light of the body. Fails if:
// these meet a state that only a gathering of this session would have made.
TEST(SessionCache, BouncesAreFoundAfterAnImageWithoutThem) {
  const ScratchFolder folder;
  Scene without = two_balls();
  without.settings.method = Method::volume_diffusion;
  Scene with = without;
  with.settings.bounces = 1;
  for (int run = 0; run < 2; ++run) {
    StageCache cache(folder.path.string());
    Session session(&cache);
    if (run == 1) {
      EXPECT_TRUE(same_pixels(picture_of(session, without), cold_picture(without)));
    }
    EXPECT_TRUE(same_pixels(picture_of(session, with), cold_picture(with)));
    EXPECT_EQ(session.work().found > 0, run == 1);
  }
}

// Claim: a spoiled entry costs its stage alone and one warning; the picture is the same. Source: session.h.
// Fails if: the result is computed but the key's entry not replaced (the second time warns again).
TEST(SessionCache, SpoiledEntry) {
  const ScratchFolder folder;
  Scene scene = two_balls();
  scene.settings.bounces = 1;
  Image expected;
  {
    StageCache cache(folder.path.string());
    Session session(&cache);
    expected = picture_of(session, scene);
  }
  for (const CacheEntry& entry : list_cache(folder.path.string())) {
    if (entry.stage == "light" && entry.bytes % 2 == 1) continue;
    std::string bytes = bytes_of(folder.file(entry.file));
    bytes[bytes.size() / 2] = char(bytes[bytes.size() / 2] ^ 4);
    put_bytes(folder.file(entry.file), bytes);
    for (const bool spoiled : {true, false}) {
      StageCache cache(folder.path.string());
      Session session(&cache);
      EXPECT_TRUE(same_pixels(picture_of(session, scene), expected));
      const SessionWork& work = session.work();
      EXPECT_EQ(work.samples_placed > 0, spoiled && entry.stage == "samples");
      EXPECT_EQ(work.lights_traced, spoiled && entry.stage == "light" ? 1u : 0u);
      EXPECT_EQ(work.nodes_built > 0, spoiled && entry.stage == "octree");
      EXPECT_EQ(cache.warning().find(entry.file) != std::string::npos, spoiled) << cache.warning();
    }
  }
}

// Claim: the shapes of a tabulated profile are kept, one a channel, and come back bit for bit: another process walks
// nothing. Source: one notion of keys. Fails if: the shape is kept before it is walked, or under the lengths of a scene.
TEST(SessionCache, WalkedProfilesAreKept) {
  const ScratchFolder folder;
  Scene scene = two_balls();
  for (Medium& medium : scene.media) {
    medium.profile = ProfileKind::tabulated;
    medium.eta = 1.37;  // no other test of this process tabulates it: a shape in memory would not be written
  }
  std::vector<Image> pictures;
  for (int run = 0; run < 2; ++run) {
    StageCache cache(folder.path.string());
    Session session(&cache);
    pictures.push_back(picture_of(session, scene));
    EXPECT_EQ(cache.warning(), "");
  }
  EXPECT_TRUE(same_pixels(pictures[0], pictures[1]));
  const DiffuseProfile profile = make_diffuse_profile(scene.media[0]);
  StageCache cache(folder.path.string());
  for (const ChannelProfile& channel : profile.channels) {
    const TabulatedProfile& walked = std::get<TabulatedProfile>(channel);
    const auto kept = cache.find(walked_profile_key(walked.medium), WalkedProfileCodec{});
    ASSERT_TRUE(kept);
    for (const double r : {.01, 1., 40.}) EXPECT_EQ(kept->density(r), walked.shape->get().table.density(r));
  }
}

}  // namespace
}  // namespace opaline
