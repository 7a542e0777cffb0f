// SPDX-License-Identifier: GPL-3.0-or-later
// `opaline render --part` and `opaline merge`: one image by several processes.
#include <algorithm>

#include "cache/content_hash.h"
#include "opaline/image.h"
#include "run_program.h"

namespace opaline {
namespace {

using Words = std::vector<std::string>;

const Words kJson{"--log", "json"};

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// A ball under two lights, by few random walks.
struct PartsFolder : SceneFolder {
  Words walks{"--method",
              "volume",
              "--set",
              "settings.samples=60",
              "--set",
              "mm_per_unit=0.1",
              "--set",
              "film.pixel_type=float",
              "--set",
              R"(lights=[{"name":"key","type":"point","position":[20,30,40],"intensity":1000},)"
              R"({"name":"back","type":"sphere","center":[0,40,-40],"radius":4,"radiance":[9,5,2]}])"};

  Outcome render(const std::string& output, const Words& more) const {
    return run_program(Words{"render", scene, "-o", file(output)} + more);
  }
  /// in    of: "3/8"
  Outcome part(const std::string& of, const std::string& output, const Words& more) const {
    return render(output, Words{"--part", of} + more);
  }
  /// Ends a whole image's only part by Ctrl-C once it has stored passes.
  /// in    stage: with passes
  Outcome interrupted_part(const std::string& output, const Words& options, const std::string& stage) const {
    const Words line = Words{"render", scene, "-o", file(output), "--log", "json", "--part", "1/1"} + options;
    const auto stores_passes = [&](const Outcome& stopped) {
      return contains(stopped.out, output + " stores the complete passes; resume with ");
    };
    Outcome stopped;
    for (int delay = 0; delay < 20 && !stores_passes(stopped); ++delay) {
      std::filesystem::remove(file(output));
      Child child(line);
      EXPECT_TRUE(child.prints(R"({"event":"progress","stage":")" + stage + '"'));
      std::this_thread::sleep_for(std::chrono::milliseconds(5 * delay));
      child.send(SIGINT);
      stopped = child.wait(20);
    }
    EXPECT_TRUE(stores_passes(stopped)) << stopped.out;
    return stopped;
  }
  Outcome merge(const Words& parts, const Words& more = {}) const {
    Words words{"merge", "-o", file("merged.exr")};
    for (const std::string& name : parts) words.push_back(file(name));
    return run_program(words + more);
  }
  bool are_equal(const std::string& a, const std::string& b) const {
    return bytes_of(file(a)) == bytes_of(file(b)) && !bytes_of(file(a)).empty();
  }
};

/// The bytes of a part with another content, and the checksum of that.
template <class Change>
std::string forged(std::string bytes, const Change& change) {
  bytes.resize(bytes.size() - 32);
  change(bytes);
  ContentHash hash;
  hash.add(bytes.data(), bytes.size());
  return bytes + hex(hash.value());
}

nlohmann::json done_of(const Outcome& outcome) {
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err << outcome.out;
  return outcome.exit_code == 0 ? event_of(events_of(outcome.out), "done") : nlohmann::json();
}

void expect_refused(const Outcome& outcome, const std::string& text) {
  EXPECT_EQ(outcome.exit_code, 2) << text << outcome.err;
  EXPECT_TRUE(contains(outcome.err, text)) << text << '\n' << outcome.err;
}

// Claim: three parts of random walks, in any order, on any number of threads, merge to the bytes of one process, with all
// layers, mattes and metadata, and to the same errors. Source: the help. Tolerance: none. Fails if: passes are added in
// another order, or as floats, the layers of the parts' command are not those of the merged image, or one machine's walks are taken for another's.
TEST(CliParts, OfRandomWalksMergeToTheBytesOfOneProcess) {
  const PartsFolder folder;
  const Words options = folder.walks + Words{"--layers", "all,cryptomatte"};
  const nlohmann::json one = done_of(folder.render("one.exr", options + kJson));
  for (const std::string number : {"1", "2", "3"})
    ASSERT_EQ(folder.part(number + "/3", number + ".part", options + Words{"--threads", number}).exit_code,
              0);
  const nlohmann::json merged = done_of(folder.merge({"3.part", "1.part", "2.part"}, kJson));
  EXPECT_TRUE(folder.are_equal("one.exr", "merged.exr"));
  EXPECT_EQ(read_image(folder.file("one.exr")).metadata, read_image(folder.file("merged.exr")).metadata);
  for (const char* error : {"walks", "walk_noise", "estimated_error", "samples"})
    EXPECT_EQ(one[error], merged[error]) << error;
  EXPECT_EQ(folder.entries(), 6u);  // the scene, two images, three parts

  // Walks of a processor with other instructions have another key.
  put_bytes(folder.file("2.part"), forged(bytes_of(folder.file("2.part")), [](std::string& bytes) {
              char& digit = bytes[bytes.find("\"sources\":[\"") + 12];
              digit = digit == '0' ? '1' : '0';
            }));
  expect_refused(folder.merge({"1.part", "2.part", "3.part"}),
                 "2.part: has random walks of another kind of machine");
}

// Claim: two parts of direct, of one frame and a crop across tiles, merge to the bytes of one process. Source: the help.
// Tolerance: none. Fails if: a tile has no part or two, or is read back in another order; the merged image is of another
// frame.
TEST(CliParts, OfDirectMergeToTheBytesOfOneProcess) {
  const PartsFolder folder;
  const Words options{"--method",        "direct",
                      "--entry-samples", "48",
                      "--crop",          "3,5,30,29",
                      "--layers",        "all",
                      "--frames",        "3",
                      "--set",           "film.pixel_type=float",
                      "--set",           R"(camera.position={"keyed":{"1":[0,0,50],"5":[8,0,50]}})"};
  const nlohmann::json one = done_of(folder.render("one.exr", options + kJson));
  ASSERT_EQ(folder.part("1/2", "1.part", options).exit_code, 0);
  ASSERT_EQ(folder.part("2/2", "2.part", options).exit_code, 0);
  const nlohmann::json merged = done_of(folder.merge({"1.part", "2.part"}, kJson));
  EXPECT_TRUE(folder.are_equal("one.exr", "merged.exr"));
  for (const char* error : {"entry_samples", "direct_noise"}) EXPECT_EQ(one[error], merged[error]) << error;
}

// Claim: an interrupted part stores its passes, cannot be merged, and is continued by its command to the same bytes; a
// complete one is left alone. Source: the help. Fails if: the passes begin again at 0, or a complete part is rendered
// again.
TEST(CliParts, AreContinued) {
  const PartsFolder folder;
  const Words options{"--method", "direct", "--entry-samples", "4000", "--resolution", "16x16"};
  const Outcome stopped = folder.interrupted_part("1.part", options, "shading");
  EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
  expect_refused(folder.merge({"1.part"}), "1.part: is incomplete");

  // The same without the light of its passes.
  put_bytes(folder.file("dark.part"), forged(bytes_of(folder.file("1.part")), [](std::string& bytes) {
              std::fill(bytes.begin() + std::ptrdiff_t(bytes.find('\n', bytes.find('{'))) + 1, bytes.end(),
                        '\0');
            }));
  ASSERT_EQ(folder.part("1/1", "dark.part", options).exit_code, 0);

  const Outcome resumed = folder.part("1/1", "1.part", options + kJson);
  EXPECT_TRUE(contains(resumed.out, R"({"event":"wrote")")) << resumed.out;
  const std::string bytes = bytes_of(folder.file("1.part"));
  const Outcome again = folder.part("1/1", "1.part", options + kJson);
  EXPECT_TRUE(contains(again.out, R"({"event":"skipped")")) << again.out;
  ASSERT_EQ(folder.part("1/1", "fresh.part", options).exit_code, 0);
  EXPECT_TRUE(folder.are_equal("1.part", "fresh.part"));
  EXPECT_FALSE(folder.are_equal("1.part", "dark.part"));
}

// Claim: the same of random walks. Fails if: the walks begin again, or a batch is walked twice.
TEST(CliParts, OfRandomWalksAreContinued) {
  const PartsFolder folder;
  const Words options = folder.walks + Words{"--set", "settings.samples=1000"};
  EXPECT_EQ(folder.interrupted_part("1.part", options, "random walks").exit_code, 130);
  expect_refused(folder.merge({"1.part"}), "1.part: is incomplete");
  EXPECT_EQ(folder.part("1/1", "1.part", options).exit_code, 0);
  ASSERT_EQ(folder.part("1/1", "fresh.part", options).exit_code, 0);
  EXPECT_TRUE(folder.are_equal("1.part", "fresh.part"));
}

// Claim: files that do not form one image are exit 2, and the message names the file and the difference; nothing is
// written. Source: merge_command.cpp. Fails if: a comparison of the records is missing.
TEST(CliParts, OfDifferentImagesAreErrors) {
  const PartsFolder folder;
  const auto part = [&](const std::string& of, const std::string& name, const Words& more = {}) {
    const Words pass{"--method", "direct", "--entry-samples", "16", "--resolution", "40x16"};
    ASSERT_EQ(folder.part(of, name, pass + more).exit_code, 0) << name;
  };
  part("1/2", "1.part");
  part("2/2", "seed.part", {"--seed", "5"});
  part("2/2", "layers.part", {"--layers", "N"});
  part("2/2", "frame.part", {"--frames", "2"});
  part("2/3", "third.part");
  const std::string scene = bytes_of(folder.scene);
  put_bytes(folder.scene, scene + "// another\n");
  part("2/2", "scene.part");
  put_bytes(folder.scene, scene);
  part("2/2", "2.part");
  const std::string whole = bytes_of(folder.file("2.part"));
  put_bytes(folder.file("version.part"),
            forged(whole, [](std::string& bytes) { bytes.insert(bytes.find("\"version\":\"") + 11, "1"); }));
  put_bytes(folder.file("short.part"), whole.substr(0, whole.size() - 40));
  put_bytes(folder.file("copy.part"), bytes_of(folder.file("1.part")));
  put_bytes(folder.file("no.part"), "no part");
  const auto refused = [&](const std::string& name, const std::string& text) {
    expect_refused(folder.merge({"1.part", name}), folder.file(name) + ": " + text);
  };
  refused("seed.part", "was rendered with other options (expected a part of the same image as ");
  refused("layers.part", "was rendered with other options");
  refused("frame.part", "is of another frame");
  refused("third.part", "is one of 3 parts, not of 2");
  refused("scene.part", "is of another scene");
  refused("version.part", "is by another version of the program");
  refused("short.part", "is damaged: its contents differ from their checksum");
  refused("copy.part", "is part 1 of 2 (expected each part once, got " + folder.file("1.part"));
  refused("no.part", "is not a part of an image (expected a file that opaline render --part wrote)");
  refused("missing.part", "no such part");
  expect_refused(folder.merge({"third.part"}), "2 of 3 parts are missing (expected --part 1/3, 3/3)");
  put_bytes(folder.scene, scene + "// another\n");
  expect_refused(folder.merge({"1.part", "2.part"}), "differs from the scene of the parts");
  EXPECT_FALSE(std::filesystem::exists(folder.file("merged.exr")));
}

// Claim: images without parts, and options without a sense for one, are exit 2 with the way out. Source: render_part.cpp,
// arguments.cpp. Fails if: a check is missing.
TEST(CliParts, SenselessOptionsAreErrors) {
  const PartsFolder folder;
  const auto refused = [&](const std::string& of, const Words& more, const std::string& text,
                           const std::string& output = "1.part") {
    expect_refused(folder.part(of, output, more), text);
  };
  refused("1/2", {"--method", "hierarchical"}, "no passes to divide (expected --method direct or volume");
  refused("1/2", {"--method", "direct", "--until-error", "5%"}, "(expected --entry-samples N, got 5%");
  refused("1/17", folder.walks, "too many parts (expected at most 16, got 17");
  refused("1/5", {"--method", "direct"}, "too many parts (expected at most 4, got 5");
  refused("1/2", {"--method", "direct", "--set", "film.wavelengths=6"}, "no sums to continue");
  refused("1/2", folder.walks + Words{"--layers", "light_groups"}, "light groups");
  for (const std::string of : {"0/2", "1/2x", "1/5000"}) refused(of, folder.walks, "a part such as 2/8");
  refused("1/2", folder.walks, "one output that ends in .part", "1.exr");
  refused("1/2", folder.walks + Words{"--frames", "1-2"}, "--frames N", "f.##.part");
  refused("1/2", folder.walks + Words{"--resume", folder.file("r.exr")}, "cannot be combined with --resume");
  expect_refused(folder.render("1.part", folder.walks), "--part K/N");
  EXPECT_EQ(folder.entries(), 1u);
}

}  // namespace
}  // namespace opaline
