/* output_file.h - files that are written completely or not at all.
 *
 * A run that fails must not destroy the results of an earlier one. Contents are written to a temporary file beside the
 * target, which replaces it at the end; a device or a pipe cannot be replaced and is written directly. Only files that
 * were created here are removed.
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
  /* `label` begins the messages, for example "--json out.json". Throws InputError if the file cannot be written; the
   * target is not changed yet. */
  OutputFile(const std::string &path, std::string label);
  ~OutputFile(); /* without commit(), the target is unchanged */
  OutputFile(const OutputFile &) = delete;
  OutputFile &operator=(const OutputFile &) = delete;

  /* Throws InputError if the data cannot be written to the disk. */
  void write(std::string_view bytes);
  void commit();

  /* Throws InputError as the constructor does; a device or a pipe is not opened, because its reader would take closing
   * it for the end. */
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

  std::string label_, target_, beside_;   /* beside_: the temporary file, if it has a name */
  int descriptor_ = -1, remembered_ = -1; /* the index that remove_unfinished_files() uses */
  bool direct_ = false;
  std::string buffer_;
};

/* For a process that is about to end without destructors; safe in a signal handler. If more than a few dozen files are
 * open at once, the later ones remain. */
void remove_unfinished_files() noexcept;

/* Whether writing one file would replace the other, or a file that is to be written there. Devices such as /dev/null
 * are never the same file. */
bool is_same_file(const std::string &one, const std::string &other);

/* A file without a name for reading and writing, of which nothing remains; on the disk of `path` if possible. Returns
 * null, and errno, if there is no space for it. */
struct CloseFile {
  void operator()(std::FILE *file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;
File nameless_file_beside(const std::string &path);

} // namespace tandem
