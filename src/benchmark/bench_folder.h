// SPDX-License-Identifier: GPL-3.0-or-later
// Folder of a benchmark's images and finished runs.
#pragma once

#include <string>
#include <vector>

#include "benchmark/child_process.h"
#include "opaline/monitor.h"

namespace opaline {

/// Folder of a report, with pictures/ and runs/ in it, or a temporary one deleted with the object.
class BenchFolder {
 public:
  /// in    report: created if missing; empty: temporary
  /// error Error{run_failed}: cannot be created or written
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

/// A render with an image.
struct KeptRun {
  std::string name;                    ///< name of its record in runs/
  std::string picture;                 ///< within the folder
  std::string scene_key;               ///< scene key of the rendered scene
  std::vector<std::string> arguments;  ///< without the image
};

/// Reads a run from its record, if the same executable made it from the same scene with the same arguments
/// and its image exists. Otherwise runs it in a child process and records the result unless it failed.
/// out   is_kept: read from the record
/// error as run_own_child; Error{run_failed}: the record cannot be written
OwnChild run_or_recall(const BenchFolder& folder, const KeptRun& run, Monitor& monitor, bool& is_kept);

}  // namespace opaline
