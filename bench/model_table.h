// SPDX-License-Identifier: GPL-3.0-or-later
// The models' errors against random walks, by shape and medium.
#pragma once

#include <string>

namespace opaline {

/// Prints the table of models in Markdown. Scenes and truths are made in the folder where they are missing, and kept: a
/// run that was stopped goes on after the last pair that was complete.
/// error Error{bad_output} where the folder cannot be written
void print_model_table(const std::string& folder);

}  // namespace opaline
