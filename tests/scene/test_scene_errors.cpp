// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_test.h"

namespace opaline {
namespace {

// Claim: line and column count from 1, in bytes, at the start of the key or value. Source: opaline/error.h; the
// numbers are counted by hand. Fails if TokenCursor::next returns the token's end.
TEST(SceneErrors, CountFromOne) {
  const Error key = error_of("{\"film\": {},\n  \"flim\": {}}");
  EXPECT_EQ(key.line, 2);
  EXPECT_EQ(key.column, 3);
  EXPECT_STREQ(key.what(), "test.json:2:3: unknown key 'flim' in the scene (did you mean 'film'?)");
  const Error value = error_of("{\"film\": {\n\"exposure\": true}}");
  EXPECT_EQ(value.line, 2);
  EXPECT_EQ(value.column, 13);
  EXPECT_STREQ(
      value.what(),
      "test.json:2:13: 'film.exposure' has the wrong type (expected a number in [-100, 100], got true)");
}

// Claim: every wrong key or value is named with the place where it stands (the '@'), what was expected, what
// was found, and the nearest valid name. Source: scenes/README.md. Fails if the cursor does not step over
// comments.
TEST(SceneErrors, NameThePlace) {
  expect_errors({
      {"{\n // \"x\": {\n /* \n\" */ \"film\": {@\"resolutoin\": [1, 1]}}", {"in 'film'", "'resolution'"}},
      {R"({@"a \" : {,\\": 1, "b": 2})", {"unknown key", "expected one of mm_per_unit"}},
      {"{\"media\": {\n  \"stone\": {\"preset\": \"marble\",\n  @\"subsurface_colour\": 1}}}",
       {"unknown key 'subsurface_colour' in 'media.stone' (did you mean 'subsurface_color'?)"}},
      {"{\"film\": {\"exposure\": 2},\n@\"film\": {}}", {"duplicate key 'film'", "first on line 1"}},
      {R"({"film": @3})", {"'film' has the wrong type", "expected an object", "got 3"}},
      {R"({"film": {"samples_per_pixel":   @0}})", {"'film.samples_per_pixel'", "1 to 65536", "got 0"}},
      {R"({"film": {"samples_per_pixel": @1.5}})", {"a whole number", "got 1.5"}},
      {R"({"film": {"samples_per_pixel": @-1}})", {"out of range", "got -1"}},
      {R"({"film": {"filter": @"gausian"}})", {"'gausian' (did you mean 'gaussian'?)", "box, gaussian"}},
      {R"({"film": {"resolution": [@1000000000, 1000000000]}})",
       {"'film.resolution.0'", "65536", "got 1000000000"}},
      {R"({"film": {"resolution": [1, @1e9]}})", {"'film.resolution.1'", "65536", "got 1e9"}},
      {R"({"film": {"resolution": @[65536, 65536]}})", {"too many pixels", "2^28"}},
      {R"({"film": {"resolution": @[64]}})", {"[width, height]", "got [64]"}},
      {R"({"film": {"resolution": [64, 64], "crop": [0, 0, @65, 1]}})",
       {"'film.crop.2'", "0 to 64, the image's width"}},
      {R"({"film": {"crop": @[8, 0, 8, 1]}})", {"contains no pixels", "x0 < x1"}},
      {R"({"camera": {"field_of_view": @180}})", {"'camera.field_of_view'", "(0, 180)", "got 180"}},
      {R"({"camera": {"position": [1, 2, 3], "look_at": @[1, 2, 3]}})",
       {"no view direction", "got [1, 2, 3]"}},
      {R"({"camera": {"up": @[0, 0, -2]}})", {"'camera.up'", "'up' not parallel", "got [0, 0, -2]"}},
      {R"({"camera": {"field_of_view": 30, @"orthographic_height": 2}})",
       {"cannot stand beside 'camera.field_of_view'", "one of the two"}},
      {R"({"camera": {"aperture": 1, @"f_number": 2}})", {"cannot stand beside 'camera.aperture'"}},
      {R"({"camera": {"focus_distance": 1, @"focus_point": [0, 0, 0]}})", {"beside 'camera.focus_distance'"}},
      {R"({"camera": {"orthographic_height": 1, @"f_number": 2}})", {"cannot stand beside"}},
      {R"({"camera": {"aperture": @-1}})", {"'camera.aperture'", "got -1"}},
      {R"({"camera": {"aperture": @1e19}})", {"'camera.aperture'", "the distance in focus"}},
      {R"({"camera": {"f_number": @1e-20}})", {"'camera.f_number'", "the distance in focus"}},
      {R"({"camera": {"f_number": @0}})", {"'camera.f_number'", "got 0"}},
      {R"({"camera": {"blades": @2}})", {"forms no iris", "0 or at least 3", "got 2"}},
      {R"({"camera": {"shift": @[1]}})", {"'camera.shift'", "a list of 2 numbers"}},
      {R"({"mm_per_unit": @0})", {"'mm_per_unit' is out of range", "got 0"}},
      {R"({"mm_per_unit": @"mm"})", {"expected a number", "got \"mm\""}},
      {R"({"settings": {"laboratory": {"max_solid_angle": @0}}})", {"'settings.laboratory.max_solid_angle'"}},
      {R"({"settings": {"tolerance": @1e-5}})", {"'settings.tolerance' is below the limit", "at least 1e-4"}},
      {R"({"settings": {"tolerance": @2}})", {"'settings.tolerance' is out of range", "[0.0001, 1]"}},
      {R"({"settings": {"laboratory": {"near_field": @1}}})", {"true or false", "got 1"}},
      {R"({"settings": {"laboratory": {"near_field": @null}}})", {"true or false", "got null"}},
      {R"({"settings": {"evaluator": @"dualtree"}})", {"did you mean 'dual_tree'"}},
      {R"({"settings": {"sample_spacing": @-1}})", {"a length > 0"}},
      {R"({"settings": {"seed": @18446744073709551616}})", {"'settings.seed'", "18446744073709551615"}},
      {R"({"surroundings": @-1})", {"'surroundings'"}},
      {"@[]", {"the scene has the wrong type", "got []"}},
  });
}

// Claim: a medium is described in exactly one way, and each of its values is checked under its own name.
// Source: scenes/README.md; albedos 1.2 and -.1, |g| >= 1 and negative coefficients have no meaning.
// Fails if `unit_interval` in read_artist becomes `non_negative`, or `anisotropy_range` includes its ends.
TEST(SceneErrors, Media) {
  const std::string artist = R"({"subsurface_radius": 1, "subsurface_color": )";
  expect_errors({
      {with_medium(R"({"preset": @"marbel"})"), {"'media.m.preset'", "did you mean 'marble'?", "wholemilk"}},
      {with_medium("@{}"), {"'media.m' does not define", "subsurface_color + subsurface_radius"}},
      {with_medium(R"(@{"sigma_a": 1})"), {"'media.m' does not define"}},
      {with_medium(R"(@{"sigma_s_prime": 1})"), {"'media.m' lacks the key 'sigma_a'"}},
      {with_medium(R"({"preset": "cream", @"sigma_s": 1})"),
       {"'media.m.sigma_s' cannot be combined with 'preset'"}},
      {with_medium(R"({"preset": "cream", @"g": 0})"), {"'media.m.g' has no effect with 'preset'"}},
      {with_medium(R"({"sigma_a": 1, "sigma_s_prime": 1, @"g": 0})"),
       {"'media.m.g'", "with 'sigma_s_prime'"}},
      {with_medium(R"({"sigma_a": @-0.1, "sigma_s_prime": 1})"), {"'media.m.sigma_a'", "got -0.1"}},
      {with_medium(R"({"sigma_a": [0, 0, @-1], "sigma_s": 1})"), {"'media.m.sigma_a.2'", "got -1"}},
      {with_medium(R"({"sigma_a": 0, "sigma_s_prime": [0, @-1, 0]})"),
       {"'media.m.sigma_s_prime.1'", "got -1"}},
      {with_medium(R"({"sigma_a": 0, "sigma_s": @[1, 2]})"),
       {"'media.m.sigma_s'", "a list of 3", "got [1, 2]"}},
      {with_medium(R"({"sigma_a": 0, "sigma_s": @"#ffffff"})"), {"'media.m.sigma_s' has the wrong type"}},
      {with_medium(R"({"sigma_a": 0, "sigma_s": 1, "g": @1})"), {"'media.m.g'", "(-1, 1)", "got 1"}},
      {with_medium(R"({"sigma_a": 0, "sigma_s": 1, "g": @-1})"), {"'media.m.g'"}},
      {with_medium(artist + "@1.2}"), {"'media.m.subsurface_color'", "[0, 1]", "got 1.2"}},
      {with_medium(artist + "@-0.1}"), {"'media.m.subsurface_color'", "got -0.1"}},
      {with_medium(artist + "[0, @1.2, 0]}"), {"'media.m.subsurface_color.1'", "got 1.2"}},
      {with_medium(artist + "-@.1}"), {"invalid number", "a digit before the decimal point: 0.1"}},
      {with_medium(artist + "@\"#12345g\"}"), {"#rrggbb", "#12345g"}},
      {with_medium(artist + "1, \"subsurface_scatter_anisotropy\": @1}"), {"_anisotropy'", "(-1, 1)"}},
      {with_medium(R"({"preset": "cream", "scatter_anisotropy": @0.96})"),
       {"scatter_anisotropy'", "[-0.95, 0.95]"}},
      {with_medium(R"({"sigma_a": 0, "sigma_s": 1, @"scatter_anisotropy": 0})"),
       {"no effect with 'sigma_s'"}},
      {with_medium(R"({"subsurface_radius": @-1, "subsurface_color": 1})"), {"'media.m.subsurface_radius'"}},
      {with_medium(R"(@{"subsurface_color": 1})"), {"lacks the key 'subsurface_radius'"}},
      {with_medium(R"({"preset": "cream", @"eta": 1.2, "specular_ior": 1.2})"),
       {"'specular_ior' have the same meaning"}},
      {with_medium(R"({"preset": "cream", "eta": @0})"), {"'media.m.specular_ior'"}},
      {with_medium(R"({"preset": "cream", "profile": @"dipol"})"), {"did you mean 'dipole'?"}},
      {R"({"media": {@"": {"preset": "cream"}}})", {"has no name"}},
  });
}

// Claim: the same for shapes. Source: scenes/README.md. Fails if find_medium or exactly_one_of returns its
// first candidate instead of failing.
TEST(SceneErrors, Shapes) {
  const std::string moved = R"({"file": "a", "transform": )";
  expect_errors({
      {with_shapes(R"(@{"name": "a"})"), {"'shapes.0' is incomplete", "file, sphere, box"}},
      {with_shapes(R"({"file": "a", @"sphere": {"radius": 1}})"),
       {"'shapes.0.sphere' cannot be combined with 'file'"}},
      {with_shapes(R"({"sphere": {"radius": @0}})"), {"'shapes.0.sphere.radius'", "got 0"}},
      {with_shapes(R"({"sphere": {"radius": 1, @"centre": 1}})"), {"did you mean 'center'?"}},
      {with_shapes(R"({"sphere": @{}})"), {"'shapes.0.sphere' lacks the key 'radius'"}},
      {with_shapes(R"({"sphere": {"radius": 1}, @"fit_size": 1})"), {"no effect without 'file'"}},
      {with_shapes(R"({"file": @""})"), {"a nonempty string"}},
      {with_shapes(R"({"file": "a", "fit_size": @0})"), {"'shapes.0.fit_size'", "a length > 0"}},
      {with_shapes(R"({"box": {"low": [0, 0, 0], "high": @[1, 0, 1]}})"),
       {"more than 'low'", "got [1, 0, 1]"}},
      {with_shapes(R"({"quad": {"corner": [0, 0, 0], "u": [1, 0, 0], "v": @[2, 0, 0]}})"), {"spans no area"}},
      {with_shapes(R"({"torus": {"major_radius": 1, "minor_radius": @1}})"), {"less than 'major_radius'"}},
      {with_shapes(R"({"file": "a", "medium": @"k"})"), {"is not a medium", "one of m, n", "got \"k\""}},
      {with_shapes(R"({"file": "a", "medium": @"skin2"})"), {"a preset: write", R"("skin2": {"preset")"}},
      {with_shapes(R"({"file": "a", @"reflectance": 1, "medium": "m"})"),
       {"cannot be combined with 'medium'"}},
      {with_shapes(R"({"file": "a", "reflectance": @1.2})"), {"'shapes.0.reflectance'", "got 1.2"}},
      {with_shapes(R"({"file": "a", @"group": "g"})"), {"no effect without 'medium'"}},
      {with_shapes("{\"file\": \"a\", \"group\": \"g\", \"medium\": \"m\"},\n"
                   "{\"file\": \"b\", \"group\": @\"g\", \"medium\": \"n\"}"),
       {"'shapes.1.group' contains two media", "'m'"}},
      {with_shapes(R"({"file": "a", "name": "s"}, {"file": "b", "name": @"s"})"),
       {"'shapes.1.name' is already in use"}},
      {with_shapes(R"({"file": "a", "name": "shape1"}, @{"file": "b"})"), {"default name", "'shape1'"}},
      {with_shapes(R"({"file": "a", "normals": @"smoth"})"), {"did you mean 'smooth'?"}},
      {with_shapes(moved + "@{}}"), {"a list [...]"}},
      {with_shapes(moved + R"([@{"scale": 0}]})"), {"'shapes.0.transform.0' is singular"}},
      {with_shapes(moved + R"([{"scale": @1e300}]})"), {"out of range"}},
      {with_shapes(moved + R"([{"scale": 1, @"translate": [0, 0, 0]}]})"), {"exactly one of"}},
      {with_shapes(moved + R"([{"rotate": {"axis": @[0, 0, 0], "degrees": 1}}]})"),
       {"has no direction", "got [0, 0, 0]"}},
      {with_shapes(moved + R"([{"matrix": [[1, 0, 0, 0], [0, 1, 0, 0], @[0, 0, 1]]}]})"),
       {"3 rows of 4 numbers", "got [0, 0, 1]"}},
  });
}

// Claim: the same for lights. Source: scenes/README.md. Fails if type_of does not decide which keys are
// known.
TEST(SceneErrors, Lights) {
  const std::string point = R"({"type": "point", "position": [0, 0, 0], )";
  expect_errors({
      {with_light("@{}"), {"'lights.0' lacks the key 'type'", "directional"}},
      {with_light("@7"), {"'lights.0' has the wrong type"}},
      {with_light(R"({"type": @"pint"})"), {"did you mean 'point'?"}},
      {with_light(R"(@{"type": "point", "position": [0, 0, 0]})"), {"lacks the key 'intensity'"}},
      {with_light(point + R"(@"radiance": 1})"), {"unknown key 'radiance'", "did you mean 'intensity'?"}},
      {with_light(R"({"type": "quad", "corner": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0], @"color": 1})"),
       {"did you mean 'radiance'?"}},
      {with_medium(R"({"preset": "cream", @"roughness": 1})"), {"did you mean 'specular_roughness'?"}},
      {with_shapes(R"({"sphere": {"radius": 1}, @"color": 1})"), {"did you mean 'reflectance'?"}},
      {with_light(point + R"("intensity": [0, @1e31, 0]})"), {"'lights.0.intensity.1'"}},
      {with_light(point + R"("intensity": @-1})"), {"'lights.0.intensity'", "got -1"}},
      {with_light(point + R"("intensity": 1, "name": @"surroundings"})"), {"is reserved"}},
      {with_light(R"({"type": "point", "position": [0, 0, @1e19], "intensity": 1})"),
       {"'lights.0.position.2'"}},
      {with_light(R"({"type": "directional", "direction": @[0, 0, 0], "irradiance": 1})"),
       {"has no direction"}},
      {with_light(
           R"({"type": "quad", "corner": [0, 0, 0], "radiance": 1, "u": [1, 1, 0], "v": @[-1, -1, 0]})"),
       {"spans no area"}},
  });
}

// Claim: numbers as other languages write them are named with what JSON has in their place. Source: RFC 8259. Fails if: the parser's
// own words are all that is printed.
TEST(SceneErrors, NumbersOfOtherLanguages) {
  expect_errors({{R"({"film": {"exposure": @.5}})", {"broken JSON", "a digit before the decimal point: 0.5"}},
                 {R"({"film": {"exposure": -@.5}})", {"a digit before the decimal point: 0.5"}},
                 {R"({"film": {"exposure": 1.@}})", {"a digit after the decimal point, as in 1.0"}},
                 {R"({"film": {"exposure": @+5}})", {"a number without a plus sign"}},
                 {R"({"film": {"exposure": @NaN}})", {"a finite number"}},
                 {R"({"film": {"exposure": -@Inf}})", {"a finite number"}},
                 {R"({"film": {"exposure": @Infinity}})", {"a finite number"}},
                 {"{@# note\n}", {"// before a comment"}}});
}

// Claim: an object in place of another value is named by its keys. Source: by hand. Fails if: "{...}" stands for them.
TEST(SceneErrors, ObjectsAreNamedByTheirKeys) {
  expect_fragments(error_of(R"({"film": {"exposure": {"value": 3, "unit": 1}}})"),
                   {"'film.exposure' has the wrong type", "got an object with the keys 'value', 'unit'"});
  expect_fragments(error_of(R"({"film": {"exposure": {"a": 3}}})"), {"got an object with the key 'a'"});
  expect_fragments(error_of(R"({"film": {"exposure": {}}})"), {"got an object without keys"});
}

// Claim: a text in place of a number that names infinity, a number or a percentage is called so. Source: by hand. Fails if: it is the wrong type
// alone.
TEST(SceneErrors, TextsInPlaceOfNumbers) {
  for (const char* text : {"-Inf", "inf", "NaN", "+infinity"}) {
    expect_fragments(error_of("{}", {std::string("film.exposure=") + text}),
                     {"'film.exposure' is not a finite number", text});
    expect_fragments(error_of(std::string(R"({"film": {"exposure": ")") + text + "\"}}"),
                     {"'film.exposure' is not a finite number"});
  }
  expect_fragments(error_of(R"({"film": {"exposure": "0.5"}})"),
                   {"'film.exposure' is a number in quotes", "without quotes", "got \"0.5\""});
  expect_fragments(error_of("{}", {"settings.until_error=5%"}),
                   {"'settings.until_error' is a percentage (did you mean 0.05?)"});
}

}  // namespace
}  // namespace opaline
