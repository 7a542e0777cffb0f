// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/part_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "opaline/error.h"

namespace opaline {
namespace {

constexpr std::string_view kMagic = "opaline part 1\n";
constexpr std::uint64_t kMostHeader = 1 << 24, kPiece = 1 << 24, kDigest = 32;

Json json_of(const PartRecord& record) {
  Json json{
      {"version", record.version},     {"scene", record.scene},           {"hash", record.hash},
      {"overrides", record.overrides}, {"all_layers", record.layers.all}, {"layers", record.layers.names},
      {"part", record.part.number},    {"parts", record.part.count}};
  if (record.frame) json["frame"] = *record.frame;
  return json;
}

PartRecord record_in(const Json& json) {
  PartRecord record{json.at("version"),
                    json.at("scene"),
                    json.at("hash"),
                    json.at("overrides"),
                    {json.at("all_layers"), json.at("layers")},
                    {},
                    {json.at("part"), json.at("parts")}};
  if (json.contains("frame")) record.frame = json.at("frame").get<int>();
  return record;
}

/// error Error{bad_input}: the last bytes are not the hash of the others
void check_digest(const std::string& path, const InputFile& file) {
  ContentHash hash;
  const std::uint64_t end = file.size() - kDigest;
  for (std::uint64_t begin = 0; begin < end; begin += kPiece) {
    const std::string bytes = file.read(begin, std::min(kPiece, end - begin));
    hash.add(bytes.data(), bytes.size());
  }
  if (file.read(end, kDigest) != hex(hash.value()))
    throw bad_file(path, "is damaged: its contents differ from their checksum");
}

}  // namespace

PartRecord record_of(const RenderArguments& arguments, const std::string& hash, std::optional<int> frame) {
  return {OPALINE_VERSION,
          std::filesystem::absolute(arguments.scene).string(),
          hash,
          arguments.overrides,
          arguments.layers,
          frame,
          *arguments.part};
}

std::string difference(const PartRecord& part, const PartRecord& other) {
  if (part.version != other.version)
    return fmt::format("is by version {} of the program, not {}", part.version, other.version);
  if (part.part.count != other.part.count)
    return fmt::format("is one of {} parts, not of {}", part.part.count, other.part.count);
  if (part.frame != other.frame) return "is of another frame";
  if (part.overrides != other.overrides || part.layers.all != other.layers.all ||
      part.layers.names != other.layers.names)
    return "was rendered with other options";
  if (part.hash != other.hash) return "is of another scene";
  return {};
}

PartFile::PartFile(const std::string& path) : path_(path), file_(path, "part") {
  const auto refused = [&] {
    return bad_file(path, "is not a part of an image", "a file that opaline render --part wrote");
  };
  const std::string start = file_.read(0, kMostHeader);
  const std::size_t end = start.find('\n', kMagic.size());
  if (!start.starts_with(kMagic) || end == std::string::npos || file_.size() < end + 1 + kDigest)
    throw refused();
  check_digest(path, file_);
  try {
    const Json json = Json::parse(start.substr(kMagic.size(), end - kMagic.size()));
    record_ = record_in(json);
    is_complete_ = json.at("complete");
    contents_ = json.at("contents");
  } catch (const Json::exception&) {
    throw refused();
  }
  const ImagePart& part = record_.part;
  if (part.number < 1 || part.number > part.count || part.count > kMostParts) throw refused();
  begin_ = end + 1;
  end_ = file_.size() - kDigest;
}

std::string PartFile::bytes_at(std::uint64_t offset, std::uint64_t count, std::uint64_t item_bytes) const {
  if (offset > end_ - begin_ || count > (end_ - begin_ - offset) / item_bytes)
    throw bad_file(path_, "is damaged: it has fewer values than its header states");
  return file_.read(begin_ + offset, count * item_bytes);
}

PartOutput::PartOutput(const std::string& path, const PartRecord& record, bool is_complete,
                       const Json& contents)
    : file_(path) {
  Json json = json_of(record);
  json["complete"] = is_complete;
  json["contents"] = contents;
  append(std::string(kMagic) + compact(json) + '\n');
}

void PartOutput::append(std::string_view bytes) {
  hash_.add(bytes.data(), bytes.size());
  file_.append(bytes);
}

void PartOutput::commit() {
  file_.append(hex(hash_.value()));
  file_.commit();
}

}  // namespace opaline
