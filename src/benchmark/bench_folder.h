// SPDX-License-Identifier: GPL-3.0-or-later
// Where a benchmark's pictures lie, and the runs that need not be done again.
#pragma once

#include <string>
#include <vector>

#include "benchmark/child_process.h"
#include "opaline/monitor.h"

namespace opaline {

/// The folder of a report, with pictures/ and runs/ in it; or a temporary one that goes with this object.
class BenchFolder {
 public:
  /// in    report: made if it is not there; empty: temporary
  /// error Error{run_failed}: cannot be made or written
  explicit BenchFolder(const std::string& report);
  ~BenchFolder();
  BenchFolder(const BenchFolder&) = delete;
  BenchFolder& operator=(const BenchFolder&) = delete;

  bool is_report() const { return !temporary_; }
  std::string file(const std::string& name) const { return path_ + '/' + name; }

 private:
  std::string path_;
  bool temporary_ = false;
};

/// A render leaving a picture.
struct KeptRun {
  std::string name;                    ///< name of its record in runs/
  std::string picture;                 ///< within the folder
  std::string scene_key;               ///< scene key of what is rendered
  std::vector<std::string> arguments;  ///< without the picture
};

/// The run as its record has it, if this very program did it on the same scene with the same arguments and
/// the picture is there; else a child does it now, and what it said is recorded unless it failed.
/// out   is_kept: it was not run
/// error as run_own_child; Error{run_failed}: the record cannot be written
OwnChild run_or_recall(const BenchFolder& folder, const KeptRun& run, Monitor& monitor, bool& is_kept);

}  // namespace opaline
