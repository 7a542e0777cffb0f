// SPDX-License-Identifier: GPL-3.0-or-later
// Module opaline._opaline: sessions, images and comparisons. opaline/__init__.py adds scenes with numpy arrays.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>

#include "bodies/plan.h"
#include "core/lower_case.h"
#include "input/presets.h"
#include "opaline/opaline.h"
#include "plan/expected_error.h"
#include "python/interruptible.h"
#include "python/profile_binding.h"
#include "scene/names.h"
#include "session/session_records.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace opaline {
namespace {

using SharedImage = std::shared_ptr<Image>;
using Floats = nb::ndarray<nb::numpy, float>;
template <class T>
using Triples = nb::ndarray<const T, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

// Set once by the module, for the translator of exceptions.
PyObject* bad_input = nullptr;
PyObject* run_failed_error = nullptr;

void set_python_error(const Error& failure) {
  if (failure.kind == ErrorKind::interrupted) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    return;
  }
  const nb::handle type = failure.kind == ErrorKind::bad_input ? bad_input : run_failed_error;
  const nb::object error = type(failure.what());
  error.attr("file") = failure.file;
  error.attr("line") = failure.line;
  error.attr("column") = failure.column;
  error.attr("message") = failure.message;
  error.attr("expected") = failure.expected;
  error.attr("got") = failure.got;
  PyErr_SetObject(type.ptr(), error.ptr());
}

/// Rows of pixels of a layer, sharing the image's memory: height x width x 3, or height x width.
/// error KeyError: no such layer
Floats layer_view(const SharedImage& image, const std::string& name) {
  const auto place = [&](const std::string& channel) {
    return std::size_t(std::ranges::find(image->channels, channel) - image->channels.begin());
  };
  const std::size_t step = image->channels.size();
  const std::string prefix = name.empty() ? "" : name + '.';
  const auto has = [&](std::size_t at, const char* rest) {
    return at < step && image->channels[at] == prefix + rest;
  };
  std::size_t first = place(name), count = 1;
  for (const auto& [a, b, c] : {std::array{"R", "G", "B"}, std::array{"X", "Y", "Z"}})
    if (const std::size_t at = place(prefix + a); has(at, a) && has(at + 1, b) && has(at + 2, c)) {
      first = at;
      count = 3;
      break;
    }
  if (first == step) throw nb::key_error(("no layer '" + name + "' in the image").c_str());
  const auto height = std::size_t(image->height), width = std::size_t(image->width);
  const auto owner = nb::cast(image);
  const std::size_t shape[] = {height, width, count};
  const auto signed_step = std::int64_t(step);
  const std::int64_t strides[] = {std::int64_t(width) * signed_step, signed_step, 1};
  return Floats(image->pixels.data() + first, count == 1 ? 2 : 3, shape, owner, strides);
}

/// All channels: height x width x channels, sharing the image's memory.
Floats all_channels(const SharedImage& image) {
  const std::size_t shape[] = {std::size_t(image->height), std::size_t(image->width), image->channels.size()};
  return Floats(image->pixels.data(), 3, shape, nb::cast(image));
}

SharedImage image_of(const nb::ndarray<const float, nb::ndim<3>, nb::c_contig, nb::device::cpu>& pixels,
                     std::vector<std::string> channels) {
  if (channels.size() != pixels.shape(2))
    throw nb::value_error("one name is needed for each channel of height x width x channels");
  auto image = std::make_shared<Image>();
  image->height = image->full_height = int(pixels.shape(0));
  image->width = image->full_width = int(pixels.shape(1));
  image->channels = std::move(channels);
  image->pixels.resize(pixels.size());
  std::copy_n(pixels.data(), pixels.size(), image->pixels.data());
  return image;
}

void write_image(const Image& image, const std::string& path, bool half, double exposure,
                 const std::string& view) {
  const std::string ending = in_lower_case(path.substr(std::max<std::size_t>(path.size(), 4) - 4));
  const bool is_png = ending == ".png";
  if (!is_png && ending != ".exr") throw nb::value_error("a name that ends in .exr or .png");
  const auto names = names_of(ViewTransform{});
  const auto found = std::ranges::find(names, view);
  if (found == names.end()) throw nb::value_error("view: soft, neutral, agx or srgb");
  if (is_png)
    write_png(path, image, exposure, ViewTransform(found - names.begin()));
  else
    write_exr(path, image, half);
}

nb::dict statistics(const ErrorStatistics& errors) {
  nb::dict values;
  values["mean"] = errors.mean;
  values["rel_mse"] = errors.mean_square;
  values["p99"] = errors.p99;
  values["max"] = errors.largest;
  values["signed"] = errors.signed_mean;
  return values;
}

nb::dict compare_images(const Image& image, const Image& reference, const std::string& layer) {
  const Layer a = extract_layer(image, layer), b = extract_layer(reference, layer);
  if (a.channels.empty() || a.channels.size() != b.channels.size() || a.width != b.width ||
      a.height != b.height)
    throw nb::value_error("both images need this layer at the same size");
  const RelativeErrors errors = relative_errors(a, b, object_pixels(reference));
  nb::dict result = statistics(error_statistics(errors));
  nb::dict channels;
  for (std::size_t c = 0; c < a.names.size(); ++c)
    channels[a.names[c].c_str()] = statistics(error_statistics(errors.channels[c]));
  result["channels"] = channels;
  if (a.channels.size() == 3) {
    const std::vector<float> visible = flip(a, b, display_exposure(b, object_pixels(reference)));
    double sum = 0;
    for (const float value : visible) sum += double(value);
    result["flip"] = sum / double(visible.size());
  }
  return result;
}

nb::dict plan_of(const Session& session) {
  const Plan& plan = session.plan();
  nb::dict result;
  result["triangles"] = plan.triangles;
  result["memory_bytes"] = plan.bytes;
  result["stages"] = plan.stages;
  result["warnings"] = plan.warnings;
  result["expected_model_error"] = expected_model_error(plan);
  nb::list bodies;
  for (const BodyPlan& body : plan.groups) {
    nb::dict item;
    item["name"] = body.name;
    item["medium"] = session.scene().media[body.medium].name;
    item["method"] = std::string(name_of(body.method));
    item["reason"] = body.reason_against_method;
    item["area_mm2"] = body.area;
    item["samples"] = body.samples;
    item["mean_free_path_mm"] = body.smallest_mean_free_path;
    bodies.append(item);
  }
  result["bodies"] = bodies;
  return result;
}

/// A session with the text of its scene. One thread uses it at a time; others are refused.
class PythonSession {
 public:
  /// text: a scene file's; none: the file is read, a scene or an asset
  void edit(const std::string& file, const std::optional<std::string>& text,
            const std::vector<std::string>& overrides, int frame) {
    const Use use(is_used_);
    interruptible([&](Monitor&) {
      session_.edit(text ? parse_scene(*text, file, overrides, frame) : load_scene(file, overrides, frame));
    });
    error_ = -1;
  }

  SharedImage render() {
    const Use use(is_used_);
    RenderResult result = interruptible([&](Monitor& monitor) { return session_.render(&monitor); });
    error_ = estimated_relative_error(result.image, result.translucent);
    return std::make_shared<Image>(std::move(result.image));
  }

  std::optional<double> estimated_error() const { return error_ > 0 ? std::optional(error_) : std::nullopt; }

  nb::ndarray<nb::numpy, float, nb::shape<-1, 3>> exitance(std::size_t body, const Triples<double>& points,
                                                           const Triples<float>& normals) {
    const Use use(is_used_);
    if (points.shape(0) != normals.shape(0)) throw nb::value_error("one normal is needed for each point");
    std::vector<Vec3d> places(points.shape(0));
    std::vector<Vec3f> directions(points.shape(0));
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double* const p = points.data() + 3 * i;
      const float* const n = normals.data() + 3 * i;
      places[i] = {p[0], p[1], p[2]};
      directions[i] = {n[0], n[1], n[2]};
    }
    auto* const values = new std::vector<float>;
    const nb::capsule owner(values,
                            [](void* owned) noexcept { delete static_cast<std::vector<float>*>(owned); });
    for (const RgbF& color :
         interruptible([&](Monitor&) { return session_.radiant_exitance(body, places, directions); }))
      values->insert(values->end(), {color.x, color.y, color.z});
    return {values->data(), {places.size(), 3}, owner};
  }

  nb::dict plan() {
    const Use use(is_used_);
    return plan_of(session_);
  }
  std::vector<std::string> decisions() {
    const Use use(is_used_);
    return session_.decisions();
  }
  void hold_view(bool hold) {
    const Use use(is_used_);
    session_.hold_view(hold);
  }

 private:
  /// Python's lock guards the flag; the work itself runs without the lock.
  class Use {
   public:
    explicit Use(bool& is_used) : is_used_(is_used) {
      if (is_used_) throw std::runtime_error("the session is in use by another thread");
      is_used_ = true;
    }
    ~Use() { is_used_ = false; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    bool& is_used_;
  };

  Session session_;
  double error_ = -1;
  bool is_used_ = false;
};

void set_threads(int threads) {
  static std::unique_ptr<tbb::global_control> limit;
  if (threads < 0) throw nb::value_error("threads: 0 for one for each core, or more");
  limit.reset();
  if (threads > 0)
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  std::size_t(threads));
}

PyObject* new_exception(nb::module_& module, const char* name, PyObject* base, const char* text) {
  const std::string full = std::string("opaline.") + name;
  PyObject* const type = PyErr_NewExceptionWithDoc(full.c_str(), text, base, nullptr);
  module.attr(name) = nb::borrow(type);
  return type;
}

}  // namespace
}  // namespace opaline

NB_MODULE(_opaline, module) {
  using namespace opaline;
  module.doc() = "Rendering of translucent assets: sessions, images, comparisons.";
  module.attr("__version__") = OPALINE_VERSION;
  PyObject* const error =
      new_exception(module, "Error", PyExc_RuntimeError,
                    "An error of opaline, with file, line, column, message, expected and got.");
  bad_input = new_exception(module, "BadInput", error, "A scene, asset or value that cannot be used.");
  run_failed_error =
      new_exception(module, "RunFailed", error, "A file that cannot be written, or too little memory.");
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const Error& failure) {
      set_python_error(failure);
    }
  });

  nb::class_<Image>(module, "Image", "Float layers of an image; radiance in linear Rec.709, W/(mm^2 sr).")
      .def_ro("width", &Image::width)
      .def_ro("height", &Image::height)
      .def_ro("channels", &Image::channels, "Names, such as 'R', 'diffuse.R', 'N.X', 'Z'.")
      .def_ro("metadata", &Image::metadata)
      .def_prop_ro(
          "color", [](const SharedImage& image) { return layer_view(image, ""); },
          "R, G and B: height x width x 3, without a copy.")
      .def_prop_ro("array", &all_channels, "All channels: height x width x channels, without a copy.")
      .def("__getitem__", &layer_view, "layer"_a,
           "A layer such as 'diffuse' (height x width x 3) or 'Z' (height x width), without a copy.")
      .def("write", &write_image, "path"_a, "half"_a = true, "exposure"_a = 0.0, "view"_a = "soft",
           "Writes an EXR, or a PNG after the exposure (stops) and view transform.");
  module.def("image", &image_of, "pixels"_a, "channels"_a,
             "An image of an array, height x width x channels.");
  module.def(
      "read_image", [](const std::string& path) { return std::make_shared<Image>(read_image(path)); },
      "path"_a, "Reads an EXR, HDR or PNG as linear Rec.709.");
  module.def("compare", &compare_images, "image"_a, "reference"_a, "layer"_a = "",
             "Relative errors over the pixels that the reference covers: mean, rel_mse, p99, max, signed; by "
             "channel; "
             "and the mean of FLIP.");
  module.def("set_threads", &set_threads, "threads"_a, "Largest number of threads; 0: one for each core.");
  module.def("presets", [] {
    std::vector<std::string> names;
    for (const Preset& preset : presets()) names.emplace_back(preset.name);
    return names;
  });
  add_profile(module);
  nb::class_<PythonSession>(module, "Session")
      .def(nb::init<>())
      .def("edit", &PythonSession::edit, "file"_a, "text"_a.none(), "overrides"_a, "frame"_a = 1)
      .def("render", &PythonSession::render)
      .def_prop_ro("estimated_error", &PythonSession::estimated_error)
      .def("radiant_exitance", &PythonSession::exitance, "body"_a, "points"_a, "normals"_a)
      .def("plan", &PythonSession::plan)
      .def_prop_ro("decisions", &PythonSession::decisions)
      .def("hold_view", &PythonSession::hold_view, "hold"_a);
}
