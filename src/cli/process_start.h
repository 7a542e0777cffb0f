// SPDX-License-Identifier: GPL-3.0-or-later
// Safe state of inherited descriptors and signals, before anything else.
#pragma once

namespace opaline {

/// Call first in main. Opens closed descriptors 0 to 2 as /dev/null, so messages never reach an output file
/// opened under their number; writing to them still fails. Writing beyond the file size limit then fails
/// instead of ending the process with its temporary file left behind. (An out-of-memory exception escaping a
/// library ends the process as from main, with one line and exit code 3, even before main.)
void prepare_process();

/// True if standard output came closed.
bool was_started_without_output();

}  // namespace opaline
