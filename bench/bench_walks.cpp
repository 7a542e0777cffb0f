// SPDX-License-Identifier: GPL-3.0-or-later
// What random walks inside bodies cost, and what they bring.
//
//   bench_walks SCENE [KEY=VALUE ...]
//
// KEY=VALUE as for `opaline render --set`. "worth" is 1 / (noise^2 seconds): twice as much reaches the same error in half
// the time. Noise is VolumeExitance::relative_error, seconds are user CPU of all threads, the median of three.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "input/load_scene.h"
#include "methods/volume/volume_state.h"
#include "session/session_records.h"
#include "user_seconds.h"

using namespace opaline;

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const std::vector<std::string> overrides(argv + 2, argv + argc);
  Scene scene = load_scene(argv[1], overrides);
  scene.settings.method = Method::volume;
  std::vector<double> seconds;
  for (int repeat = 0; repeat < 3; ++repeat) {
    Session session;
    session.edit(scene);
    seconds.push_back(user_seconds([&] { session.prepare(); }));
    if (repeat < 2) continue;
    const double time = median(seconds);
    for (const Body& body : session.bodies()) {
      const VolumeExitance& walked = volume_state(body).exitance.value;
      double leaves = 0, area = 0;
      for (std::size_t i = 0; i < walked.exitance.size(); ++i) {
        leaves += double(body.surface.samples[i].area) * double(walked.exitance[i].y);
        area += double(body.surface.samples[i].area);
      }
      fmt::print(
          "{}: {} samples, {} walks a sample, channel and light: noise {:.2f} %, {:.2f} s, worth {:.2f}; "
          "mean exitance "
          "{:.5g} (green), lost {:.1g}\n",
          body.plan.name, walked.exitance.size(), walked.walks, 100 * walked.relative_error, time,
          1 / (walked.relative_error * walked.relative_error * time), leaves / area,
          max_component(walked.lost));
    }
  }
}
