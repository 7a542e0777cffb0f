// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/render_outputs.h"

#include <algorithm>

#include "opaline/core/atomic_file.h"
#include "opaline/core/error.h"
#include "opaline/render/layers.h"
#include "opaline/scene/names.h"

namespace opaline {

void check_writable(const RenderArguments& arguments) {
  for (const std::string& path : arguments.outputs) const AtomicFile probe(path);
  if (!arguments.samples_ply.empty()) const AtomicFile probe(arguments.samples_ply);
  if (!arguments.resume.empty()) const AtomicFile probe(arguments.resume);
}

void check_layers(const LayerChoice& layers, Method method) {
  const std::vector<std::string> channels = layer_names(method);
  for (const std::string& layer : layers.names)
    if (std::ranges::none_of(channels, [&](const std::string& channel) {
          return channel.substr(0, channel.find('.')) == layer;
        }))
      throw Error(ErrorKind::bad_input, {}, 0, 0,
                  "--layers: there is no layer '" + layer + "' with this method",
                  layer == "variance" ? "--method direct" : "another --method", std::string(name_of(method)));
}

WriteReport write_picture(const std::string& path, const Image& image, const Film& film,
                          const LayerChoice& layers) {
  if (output_format(path) == OutputFormat::exr) return write_exr(path, image, film.half, layers);
  write_png(path, image, film.exposure);
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
    print_warning(arguments.log, std::to_string(cut) +
                                     " values above 65504 do not fit 16 bits and were cut; "
                                     "--set film.pixel_type=float keeps them");
  return written;
}

}  // namespace opaline
