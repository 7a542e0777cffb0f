// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/render_outputs.h"

#include <algorithm>
#include <filesystem>

#include "core/atomic_file.h"
#include "image/texture_file.h"
#include "lights/environment_picture.h"
#include "opaline/error.h"
#include "render/layers.h"
#include "render/mattes.h"
#include "scene/names.h"
#include "scene/scene_properties.h"
#include "session/light_groups.h"
#include "session/write_samples.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

/// Input files of a scene. A name with <UDIM> represents several.
std::vector<std::string> input_files(const Scene& scene) {
  std::vector<std::string> files{scene.file};
  for (const Shape& shape : scene.shapes) {
    if (const auto* mesh = std::get_if<MeshFile>(&shape.source)) files.push_back(mesh->path);
    for (const Texture* texture : textures_of(scene, shape))
      if (texture->source->image() != nullptr) files.push_back(texture->source->path());
  }
  for (const Light& light : scene.lights)
    if (const auto* environment = std::get_if<EnvironmentLight>(&light.source))
      files.push_back(environment->picture->path());
  return files;
}

/// True if a name, with any tile in place of <UDIM>, refers to an existing file.
bool is_name_of(const std::string& name, const std::string& file) {
  constexpr std::string_view kTile = "<UDIM>";
  constexpr std::size_t kDigits = 4;
  std::string other = name;
  if (const std::size_t tile = name.find(kTile); tile != name.npos) {
    const std::size_t behind = name.size() - tile - kTile.size() + kDigits;
    if (file.size() < behind) return false;
    other.replace(tile, kTile.size(), file.substr(file.size() - behind, kDigits));
  }
  std::error_code missing;
  return std::filesystem::equivalent(other, file, missing);
}

}  // namespace

void check_outputs_are_no_inputs(const RenderArguments& arguments, const Scene& scene) {
  const std::vector<std::string> inputs = input_files(scene);
  std::vector<std::string> outputs = arguments.outputs;
  if (!arguments.samples_ply.empty()) outputs.push_back(arguments.samples_ply);
  for (const std::string& output : outputs)
    if (std::ranges::any_of(inputs, [&](const std::string& input) { return is_name_of(input, output); }))
      throw bad_file(output, "is an input of the scene and would be overwritten", "another output name");
}

void check_writable(const RenderArguments& arguments) {
  for (const std::string& path : arguments.outputs) const AtomicFile probe(path);
  if (!arguments.samples_ply.empty()) const AtomicFile probe(arguments.samples_ply);
  if (!arguments.resume.empty()) const AtomicFile probe(arguments.resume);
}

void check_layers(const LayerChoice& layers, const Scene& scene) {
  const Method method = scene.settings.method;
  const std::vector<std::string> channels = layer_names(method_of(method).layers());
  if (is_named(layers, kLightGroups)) light_groups(scene);
  if (is_named(layers, kWavelengths) && !scene.wavelengths)
    throw Error(ErrorKind::bad_input, {}, 0, 0, "--layers wavelengths: the scene has no spectra",
                "a spectrum in the scene, or --set film.wavelengths=3");
  for (const std::string& layer : layers.names)
    if (layer != kLightGroups && layer != kCryptomatte && layer != kWavelengths &&
        std::ranges::none_of(channels, [&](const std::string& channel) {
          return channel.substr(0, channel.find('.')) == layer;
        }))
      throw Error(ErrorKind::bad_input, {}, 0, 0, "--layers: no layer '" + layer + "' with this method",
                  layer == "variance" ? "--method direct" : "another --method", std::string(name_of(method)));
}

std::size_t asked_layer_bytes(const LayerChoice& layers, const Scene& scene) {
  std::size_t channels = is_named(layers, kCryptomatte) ? 4 * kMatteRanks : 0;
  if (is_named(layers, kLightGroups)) channels += 9 * light_groups(scene).size();
  if (is_named(layers, kWavelengths)) channels += 6 * (1 + scene.other_wavelengths.size());  // twice
  if (channels == 0) return 0;
  const Rectangle part = rendered_part(scene.film);
  const std::size_t pixels = std::size_t(part.x1 - part.x0) * std::size_t(part.y1 - part.y0);
  // In addition, the layers of one more image: by one light, or before the channels were added.
  return pixels * sizeof(float) * (channels + layer_names(method_of(scene.settings.method).layers()).size());
}

void add_asked_layers(StageRunner& stages, const LayerChoice& layers, Session& session, Image& image) {
  if (is_named(layers, kLightGroups))
    stages.run("light groups", [&] {
      add_light_groups(session, image, &stages.monitor());
      return 0;
    });
  if (is_named(layers, kCryptomatte))
    stages.run("mattes", [&] {
      add_mattes({session.scene(),
                  session.world(),
                  session.rays(),
                  {},
                  &stages.monitor(),
                  nullptr,
                  {},
                  session.adaptive_rays()},
                 image);
      return 0;
    });
}

WriteReport write_picture(const std::string& path, const Image& image, const Film& film,
                          const LayerChoice& layers) {
  if (output_format(path) == OutputFormat::exr)
    return write_exr(path, image, film.half, layers, film.color_space);
  write_png(path, image, film.exposure, film.view);
  return {};
}

std::vector<std::string> write_outputs(const RenderArguments& arguments, const Session& session,
                                       const Image& image) {
  std::size_t cut = 0;
  std::vector<std::string> written;
  for (const std::string& path : arguments.outputs) {
    cut = std::max(cut, write_picture(path, image, session.scene().film, arguments.layers).half_overflow);
    written.push_back(path);
  }
  if (!arguments.samples_ply.empty()) {
    write_samples_ply(arguments.samples_ply, session.bodies(), session.world());
    written.push_back(arguments.samples_ply);
  }
  if (cut > 0)
    print_warning(arguments.log,
                  std::to_string(cut) +
                      " values exceed 65,504, the maximum of half precision, and are clamped; --set "
                      "film.pixel_type=float keeps them");
  return written;
}

}  // namespace opaline
