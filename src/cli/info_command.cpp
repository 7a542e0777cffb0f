// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands.h"
#include "cli/report.h"
#include "input/load_scene.h"
#include "plan/choose_models.h"
#include "plan/make_plan.h"
#include "plan/placement_warnings.h"

namespace opaline {

void info_command(const InfoArguments& arguments) {
  Scene scene = load_scene(arguments.scene, arguments.overrides);
  const World world = make_world(scene);
  choose_models(scene, world);
  const Plan plan = make_plan(scene, world);
  warn_of_unused_media(arguments.log, arguments.overrides, scene);
  print_plan(arguments.log, scene, world, plan);
  for (const std::string& text : placement_warnings(scene, world, plan)) print_warning(arguments.log, text);
  print_plates(arguments.log, compare_plates(scene, plan));
}

}  // namespace opaline
