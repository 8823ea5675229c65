/* output_file.h - files written whole or not at all.
 *
 * A run that fails must not cost the results of the one before. What is written stands in a file beside the target and
 * takes its place at the end; a device or a pipe, which nothing can take the place of, gets it at once. Nothing is
 * removed but what was made here.
 */
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace tandem {

class OutputFile {
public:
  /* `label` begins the messages, as in "--json out.json". InputError where the file cannot be written; the target is
   * not touched yet. */
  OutputFile(const std::string &path, std::string label);
  ~OutputFile(); /* without commit(), the target is as it was */
  OutputFile(const OutputFile &) = delete;
  OutputFile &operator=(const OutputFile &) = delete;

  /* InputError where the disk does not take it. */
  void write(std::string_view bytes);
  void commit();

  /* InputError as the constructor's; a device or a pipe is not opened, as its reader would take that for the end. */
  static void check(const std::string &path, const std::string &label);

private:
  explicit OutputFile(std::string label) : label_(std::move(label)) {}
  [[noreturn]] void fail(int error) const;
  void open_beside(const std::string &path);
  void flush();
  void close();
  void put(int descriptor, std::string_view bytes) const;
  void copy_to_target();
  void forget_beside();

  std::string label_, target_, beside_;   /* beside_: the file that was made here, if it has a name */
  int descriptor_ = -1, remembered_ = -1; /* as what remove_unfinished_files() knows it */
  bool direct_ = false;
  std::string buffer_;
};

/* For a process that is about to end without destructors; safe in a handler of signals. Of more than a few dozen at
 * once the later ones stay. */
void remove_unfinished_files() noexcept;

/* Whether what is written to one would take the place of the other, or of what is to be written there. Devices such as
 * /dev/null take whatever comes. */
bool is_same_file(const std::string &one, const std::string &other);

/* For reading and writing, without a name, so that nothing of it stays; on the disk of `path` where that can be. Null,
 * and errno, where there is no room for it. */
struct CloseFile {
  void operator()(std::FILE *file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;
File nameless_file_beside(const std::string &path);

} // namespace tandem
