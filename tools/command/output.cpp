/* output.cpp - writes files and JSON, and formats tables and numbers; see output.h. */
#include "tools/command/output.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/io/output_file.h"

namespace tandem {
namespace {

std::string label_of(const std::string &option, const std::string &path) { return fmt::format("{} {}", option, path); }

} // namespace

void check_writable(const std::string &option, const std::string &path)
{
  if (!path.empty()) OutputFile::check(path, label_of(option, path));
}

void write_file(const std::string &option, const std::string &path, std::string_view contents)
{
  OutputFile file(path, label_of(option, path));
  file.write(contents);
  file.commit();
}

void JsonOutput::check(DistinctFiles &files) const
{
  if (!takes_standard_output()) files.writes("--json", path);
}

void JsonOutput::check() const
{
  DistinctFiles files;
  check(files);
}

void JsonOutput::write(const Json &json) const
{
  if (path.empty()) return;
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  if (takes_standard_output()) fmt::print("{}", text);
  else write_file("--json", path, text);
}

std::string Table::text(const std::string &indent) const
{
  std::vector<size_t> widths;
  for (const auto &row : rows_)
    for (size_t c = 0; c < row.size(); ++c) {
      if (c == widths.size()) widths.push_back(0);
      widths[c] = std::max(widths[c], row[c].size());
    }
  std::string text;
  for (const auto &row : rows_) {
    std::string line = indent;
    for (size_t c = 0; c < row.size(); ++c)
      line += (c ? "  " : "") +
              (c && right_ ? fmt::format("{:>{}}", row[c], widths[c]) : fmt::format("{:<{}}", row[c], widths[c]));
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string Table::markdown(size_t left) const
{
  std::string text = fmt::format("| {} |\n|", fmt::join(rows_.front(), " | "));
  for (size_t c = 0; c < rows_.front().size(); ++c) text += c < left ? "---|" : "---:|";
  for (size_t row = 1; row < rows_.size(); ++row) text += fmt::format("\n| {} |", fmt::join(rows_[row], " | "));
  return text + "\n";
}

std::string bytes_text(uint64_t bytes)
{
  if (bytes < 1024) return fmt::format("{} B", bytes);
  if (bytes < 1024 * 1024) return fmt::format("{:.1f} KiB", static_cast<double>(bytes) / 1024);
  if (bytes < 1024ull * 1024 * 1024) return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1024 * 1024));
  return fmt::format("{:.2f} GiB", static_cast<double>(bytes) / (1024.0 * 1024 * 1024));
}

std::string hash_text(uint64_t hash) { return fmt::format("{:016x}", hash); }

} // namespace tandem
