// SPDX-License-Identifier: GPL-3.0-or-later
// Safe state of inherited descriptors and signals, before anything else.
#pragma once

namespace opaline {

/// Call first in main. Gives descriptors 0 to 2 that came closed to /dev/null, so no output file is
/// opened as one of them and written to by messages; writing to them still fails, as it does to a closed one.
/// A write beyond the file size limit then fails, too, in place of ending the process with its temporary file
/// left behind. (An exception that a library lets escape because memory ran out ends the process as it would from main,
/// with one line and exit code 3, even before main.)
void prepare_process();

/// True if standard output came closed.
bool was_started_without_output();

}  // namespace opaline
