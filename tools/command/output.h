/* output.h - the output of a command: text for people, JSON for scripts, and files.
 *
 * A run may take minutes, so a path that cannot be written is refused before it starts.
 */
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/command/distinct_files.h"

namespace tandem {

/* Keys keep the order in which they are added. */
using Json = nlohmann::ordered_json;

/* Throws InputError that names the option unless `path` can be opened for writing; an existing file is not changed. An
 * empty path is accepted. */
void check_writable(const std::string &option, const std::string &path);

/* Writes the file completely or not at all (host/io/output_file.h); throws InputError if the disk is full or fails. */
void write_file(const std::string &option, const std::string &path, std::string_view contents);

/* The value of the option --json: FILE, "-" for standard output, or empty for none. */
class JsonOutput {
public:
  std::string path;

  void check(DistinctFiles &files) const;
  void check() const; /* if there are no other files */
  /* With "-" standard output is reserved for the JSON, so commands omit their tables. */
  bool takes_standard_output() const { return path == "-"; }
  void write(const Json &json) const;
};

/* Rows of cells in aligned columns. The first column is left-aligned; the others are right-aligned if `right`. */
class Table {
public:
  explicit Table(std::vector<std::string> header, bool right = true) : rows_{std::move(header)}, right_(right) {}
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  std::string text(const std::string &indent = "") const;
  /* For a page; the columns after the first `left` are right-aligned. */
  std::string markdown(size_t left = 1) const;

private:
  std::vector<std::vector<std::string>> rows_;
  bool right_;
};

std::string bytes_text(uint64_t bytes); /* "1.5 MiB" */
std::string hash_text(uint64_t hash);   /* 16 hexadecimal digits */

} // namespace tandem
