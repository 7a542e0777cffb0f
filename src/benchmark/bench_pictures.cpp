// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/bench_pictures.h"

#include <algorithm>

#include "benchmark/bench_page.h"
#include "image/error_picture.h"
#include "opaline/image.h"

namespace opaline {
namespace {

/// R, G, B and coverage, the channels of a comparison.
Image shown_channels(const Image& image) {
  Image shown = image;
  shown.channels.clear();
  std::vector<std::size_t> places;
  for (std::size_t c = 0; c < image.channels.size(); ++c)
    if (std::string_view("RGBA").find(image.channels[c]) != std::string_view::npos) {
      shown.channels.push_back(image.channels[c]);
      places.push_back(c);
    }
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height), count = places.size();
  shown.pixels = {};
  shown.pixels.resize(pixels * count);
  for (std::size_t p = 0; p < pixels; ++p)
    for (std::size_t c = 0; c < count; ++c)
      shown.pixels[p * count + c] = image.pixels[p * image.channels.size() + places[c]];
  return shown;
}

Image image_of(const Layer& layer) {
  Image image;
  image.width = layer.width;
  image.height = layer.height;
  image.channels = {"R", "G", "B"};
  const std::size_t pixels = std::size_t(layer.width) * std::size_t(layer.height);
  image.pixels.resize(3 * pixels);
  for (std::size_t p = 0; p < pixels; ++p)
    for (std::size_t c = 0; c < 3; ++c) image.pixels[3 * p + c] = layer.channels[c][p];
  return image;
}

/// Pixels sharing a value of a reference's noise. Random walks are collected on cells, half of them visible,
/// and interpolated over about five cells.
double alike_pixels(const std::vector<std::uint8_t>& object, std::size_t cells) {
  constexpr double kSeen = .5, kBlended = 5;
  if (cells == 0) return 1;
  return std::max(1.0, double(std::ranges::count(object, 1)) / (kSeen * double(cells)) * kBlended);
}

/// A scene's two halves, for all of its rungs.
struct Reference {
  explicit Reference(const BenchScene& scene) {
    for (std::size_t h = 0; h < 2; ++h) {
      const Image image = read_image(scene.reference.halves[h]);
      halves[h] = extract_layer(image, "");
      const std::vector<std::uint8_t> shown = object_pixels(image);
      object.resize(shown.size());
      for (std::size_t p = 0; p < shown.size(); ++p) object[p] |= shown[p];
    }
    mean = mean_of(halves[0], halves[1]);
    alike = alike_pixels(object, scene.reference.cells);
  }

  PictureError error_of(const Layer& picture) const {
    return picture_error(picture, halves[0], halves[1], object, alike);
  }

  std::array<Layer, 2> halves;
  Layer mean;
  std::vector<std::uint8_t> object;
  double alike = 1;  // pixels sharing their noise
};

BenchSubject subject_of(const BenchScene& scene, const Reference& reference) {
  BenchSubject subject;
  subject.scene = scene.id;
  subject.key = scene.key;
  subject.title = scene.name;
  subject.reference = scene.reference.made;
  subject.resolution = {reference.mean.width, reference.mean.height};
  subject.is_truth = scene.reference.cells > 0;
  subject.half_noise = reference.error_of(reference.mean).worst.half_noise;
  return subject;
}

void write_pictures(const BenchFolder& folder, const std::string& name, const Image& image,
                    const Reference& reference, const Film& film) {
  const Image shown = shown_channels(image);
  const Layer layer = extract_layer(shown, "");
  write_exr(folder.file(name), shown, /*half=*/false);
  write_png(folder.file(shown_picture(name)), shown, film.exposure, film.view);
  write_png(folder.file(error_picture_of(name)),
            error_colours(relative_errors(layer, reference.mean, reference.object), layer, reference.object),
            0);
}

}  // namespace

void add_pictures(const BenchFolder& folder, const std::vector<BenchScene>& scenes,
                  const std::vector<BenchJob>& jobs, BenchReport& report) {
  for (const BenchScene& scene : scenes) {
    const Reference reference(scene);
    const Film& film = scene.scene.film;
    BenchSubject& subject = report.subjects.emplace_back(subject_of(scene, reference));
    if (folder.is_report()) {
      subject.picture = "pictures/" + scene.name + "-reference.png";
      write_png(folder.file(subject.picture), image_of(reference.mean), film.exposure, film.view);
    }
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      if (jobs[i].scene != &scene || !jobs[i].failure.empty()) continue;
      const Image image = read_image(folder.file(jobs[i].picture));
      report.rows[i].error = reference.error_of(extract_layer(image, ""));
      if (!folder.is_report()) continue;
      report.rows[i].picture = jobs[i].picture;
      write_pictures(folder, jobs[i].picture, image, reference, film);
    }
  }
}

// The same image as both halves: a reference without noise.
std::vector<BudgetRow> budget_rows(const BenchFolder& folder, const std::vector<BudgetJob>& jobs) {
  std::vector<BudgetRow> rows;
  for (const BudgetJob& job : jobs) {
    rows.push_back({job.scene->id, job.part, std::nullopt, job.failure});
    BudgetRow& row = rows.back();
    if (!job.failure.empty()) continue;
    const Image here = read_image(folder.file(job.here)), converged = read_image(folder.file(job.converged));
    const Layer reference = extract_layer(converged, "");
    row.error = picture_error(extract_layer(here, ""), reference, reference, object_pixels(converged));
  }
  return rows;
}

}  // namespace opaline
