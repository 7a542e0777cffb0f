// SPDX-License-Identifier: GPL-3.0-or-later
// Rendering of one part of an image, and the sums of all parts.
#pragma once

#include <string>

#include "cli/arguments.h"
#include "cli/stages.h"
#include "methods/direct/direct.h"
#include "session/session_records.h"

namespace opaline {

/// error Error{bad_input}: the image has no parts, or fewer
void check_part(const ImagePart& part, const Scene& scene);

/// Bytes of a part's sums, in addition to the plan.
std::size_t part_bytes(const ImagePart& part, const Session& session);

/// Renders arguments.part to its file: some passes of `volume`, or all passes of some tiles of `direct`. Continues
/// an incomplete file of the same part; returns false if it is complete. Stores the sums each minute.
/// hash, frame: of the scene
/// error Error{interrupted}, after storing the sums
bool render_part(StageRunner& stages, const RenderArguments& arguments, Session& session,
                 const std::string& hash, std::optional<int> frame);

/// Sums of all parts of a direct render.
/// error Error{bad_input} naming the file: damaged
DirectState merged_direct(const MergedParts& parts, Session& session);

/// Gives the session the random walks of all parts during this object's lifetime, one pass in memory at a time.
class MergedWalks {
 public:
  /// error as for merged_direct; in Session::prepare also: the walks are not those of this machine
  MergedWalks(const MergedParts& parts, Session& session);
  ~MergedWalks() { session_.store_walks({}); }
  MergedWalks(const MergedWalks&) = delete;
  MergedWalks& operator=(const MergedWalks&) = delete;

 private:
  Session& session_;
};

}  // namespace opaline
