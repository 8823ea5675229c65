/* embed_kernels.cpp - makes the OpenCL programs that the library contains: cl/NAME.cl with its includes, and its
 * entries.
 *
 * A line ENTRIES(STAGE) at the end of a file requests the entry of each kernel of that stage; the entries are written
 * from shared/kernels.def (entries.h). An installed program needs no source tree, because the library contains the
 * text. Each header is expanded once, where it is first included, and a .def list every time; #line directives keep the
 * compiler's messages on the file and line that people edit. FOLDER/NAME.cl is a readable copy with comments, which the
 * library omits. The text between two includes is one piece, which the library holds once for all programs that have
 * it.
 *
 * A module of another project is one program: its lists and headers are in a folder of its own, which is searched first
 * for includes, and all its kernels are of the stage that has its name.
 *
 * A library for some features alone (cmake/Features.cmake) has the entries of their kernels, and no header of a stage
 * whose kernels are all left out.
 *
 * Usage: embed_kernels ROOT FOLDER [--without FEATURE,FEATURE] cl/one.cl cl/two.cl ...
 *          writes FOLDER/embedded_kernels.cpp and FOLDER/one.cl ...
 *        embed_kernels ROOT FOLDER --module NAME SOURCES KERNELS BUFFERS NAME.cl
 *          writes FOLDER/NAME_programs.cpp and FOLDER/NAME.cl; KERNELS, BUFFERS: files of the folder SOURCES
 * Beside the source it writes a list of all files that the source was made of, for the build (the same name with .d).
 */
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/embed/entries.h"

namespace {

std::string included_name(const std::string &line)
{
  const size_t directive = line.find_first_not_of(" \t");
  if (directive == std::string::npos || line.compare(directive, 8, "#include") != 0) return {};
  const size_t open = line.find('"'), close = line.rfind('"');
  return open == std::string::npos || close == open ? std::string{} : line.substr(open + 1, close - open - 1);
}

/* The STAGE of a line ENTRIES(STAGE). */
std::string stage_wanted(const std::string &line)
{
  const std::string wish = "ENTRIES(";
  return line.starts_with(wish) && line.ends_with(')') ? line.substr(wish.size(), line.size() - wish.size() - 1) : "";
}

struct Program {
  std::string name, stage;           /* stage: empty if no entries are requested */
  std::string readable;              /* the headers with their comments */
  std::vector<std::string> headers;  /* pieces without: a #line directive, and lines up to the next include */
  std::set<std::string> seen, files; /* files: the paths of the headers in `seen` */
};

using Folders = std::vector<std::string>; /* searched for includes, in this order */

std::string path_of(const Folders &folders, const std::string &name)
{
  if (std::filesystem::path(name).is_absolute()) return name;
  for (const std::string &folder : folders)
    if (std::filesystem::exists(folder + "/" + name)) return folder + "/" + name;
  throw std::runtime_error("no file " + name + " in " + folders.front() +
                           (folders.size() > 1 ? " nor in " + folders.back() : ""));
}

/* A quarter of the text is comments, which no device needs. Their line ends are kept, so that messages name the right
 * lines; trailing blanks are not. */
std::string without_comments(const std::string &text)
{
  std::string kept;
  const auto end_line = [&] {
    kept.erase(kept.find_last_not_of(" \t") + 1);
    kept += '\n';
  };
  for (size_t at = 0; at < text.size(); ++at)
    if (text[at] == '\n') {
      end_line();
    } else if (text.compare(at, 2, "/*") != 0) {
      kept += text[at];
    } else {
      kept += ' ';
      const size_t last = std::min(text.find("*/", at + 2), text.size());
      for (; at < last; ++at)
        if (text[at] == '\n') end_line();
      ++at; /* the closing slash */
    }
  return kept;
}

std::string text_of_file(const std::string &path)
{
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(in), {}};
}

/* Where text is found, and the kernels that get an entry and those that get none. */
struct Sources {
  Folders folders;
  std::vector<embed::KernelRow> kept, left_out;
};

bool defines_any(const std::string &text, const std::vector<embed::KernelRow> &rows)
{
  return std::any_of(rows.begin(), rows.end(), [&](const embed::KernelRow &row) {
    return text.find(" " + row.name + (has_groups(row) ? "_group(" : "_item(")) != std::string::npos;
  });
}

/* A header of kernels that are all left out. Every header includes what it needs, so others do without it. */
bool is_left_out(const Sources &sources, const std::string &name)
{
  if (sources.left_out.empty()) return false;
  const std::string text = text_of_file(path_of(sources.folders, name));
  return defines_any(text, sources.left_out) && !defines_any(text, sources.kept);
}

/* What stands in a comment is neither an include nor a wish for entries. */
void expand(const Sources &sources, const std::string &name, Program &program)
{
  const bool is_list = name.ends_with(".def"); /* expanded at every include */
  if (!is_list && !program.seen.insert(name).second) return;
  const std::string path = path_of(sources.folders, name), text = text_of_file(path);
  program.files.insert(path);
  const auto begin_piece = [&](int number) {
    program.headers.push_back("#line " + std::to_string(number) + " \"" + name + "\"\n");
    program.readable += program.headers.back();
  };
  begin_piece(1);
  std::istringstream commented(text), bare(without_comments(text));
  std::string line, code;
  for (int number = 1; std::getline(commented, line) && std::getline(bare, code); ++number) {
    const std::string included = included_name(code), stage = stage_wanted(code);
    if (!stage.empty()) {
      program.stage = stage;
    } else if (included.empty()) {
      program.headers.back() += code + '\n';
      program.readable += line + '\n';
    } else if (!name.ends_with("/kernels.h") || !is_left_out(sources, included)) {
      expand(sources, included, program);
      begin_piece(number + 1);
    }
  }
}

/* String literals have a length limit on some compilers, so the text is written in pieces. */
std::string literal(const std::string &text)
{
  const size_t piece = 8000;
  std::string written;
  for (size_t at = 0; at < text.size(); at += piece) written += "R\"tandem(" + text.substr(at, piece) + ")tandem\"\n";
  return written;
}

/* The pieces of text of all programs, each once. */
class Pieces {
public:
  /* The name of the variable that holds this text. */
  std::string name_of(const std::string &text)
  {
    const auto [at, is_new] = numbers_.emplace(text, numbers_.size());
    const std::string name = "piece_" + std::to_string(at->second);
    if (is_new) variables_ += "const char " + name + "[] =\n" + literal(text) + ";\n";
    return name;
  }
  const std::string &variables() const { return variables_; }

private:
  std::map<std::string, size_t> numbers_;
  std::string variables_;
};

std::vector<embed::KernelRow> entries_of(const Program &program, const std::vector<embed::KernelRow> &rows)
{
  std::vector<embed::KernelRow> entries;
  for (const embed::KernelRow &row : rows)
    if (row.stage == program.stage && row.execution != "HOST") entries.push_back(row);
  return entries;
}

/* list: the name of the rows' file in #line directives. */
void write_program(const Program &program, const std::vector<embed::KernelRow> &entries, const std::string &list,
                   const std::string &folder, Pieces &pieces, std::ostream &out)
{
  std::ofstream readable(folder + "/" + program.name + ".cl");
  readable << program.readable;
  out << "{\"" << program.name << "\",\n{";
  for (const std::string &piece : program.headers) out << pieces.name_of(piece) << ",\n";
  out << "},{\n";
  for (const embed::KernelRow &row : entries) {
    const std::string entry = embed::entry_of(row, list);
    readable << '\n' << entry;
    out << "{\"" << row.name << "\",\n"
        << literal(entry) << ",\n"
        << literal(embed::call_of(row)) << ",\n\"" << row.local_words << "\"},\n";
  }
  out << "}},\n";
  if (!readable.flush()) throw std::runtime_error("cannot write " + folder + "/" + program.name + ".cl");
}

/* The inputs and outputs of one run of this program. */
struct Job {
  embed::Lists lists;
  std::string list_name; /* the list of kernels, in messages of compilers */
  Folders folders;
  std::vector<std::string> programs;
  std::string name_space, function, written;
  std::set<std::string> features_left_out;
};

std::set<std::string> split_at_commas(const std::string &text)
{
  std::set<std::string> words;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, ',');) words.insert(word);
  return words;
}

Job job_of_pipeline(const std::string &root, const std::string &folder, std::vector<std::string> words)
{
  Job job{{root, root + "/shared/kernels.def", ""},
          "shared/kernels.def",
          {root},
          {},
          "tandem",
          "embedded_programs",
          folder + "/embedded_kernels.cpp",
          {}};
  if (words.front() == "--without" && words.size() > 2) {
    job.features_left_out = split_at_commas(words[1]);
    words.erase(words.begin(), words.begin() + 2);
  }
  job.programs = std::move(words);
  return job;
}

Job job_of(const std::vector<std::string> &words)
{
  const std::string &root = words[0], &folder = words[1];
  if (words[2] != "--module") return job_of_pipeline(root, folder, {words.begin() + 2, words.end()});
  if (words.size() != 8) throw std::runtime_error("--module takes NAME SOURCES KERNELS BUFFERS NAME.cl");
  const std::string &name = words[3], &sources = words[4];
  return {{root, sources + "/" + words[5], sources + "/" + words[6]},
          words[5],
          {sources, root},
          {words[7]},
          name,
          "programs",
          folder + "/" + name + "_programs.cpp",
          {}};
}

/* Checks that all rows of a module have the stage of its name. */
void check_stages(const std::vector<embed::KernelRow> &rows, const Job &job)
{
  if (job.name_space == "tandem") return;
  for (const embed::KernelRow &row : rows)
    if (row.stage != job.name_space)
      throw std::runtime_error(job.lists.kernels + ":" + std::to_string(row.line) + ": kernel " + row.name +
                               " is of stage " + row.stage + "; all kernels of a module are of the stage " +
                               job.name_space + ", its name");
}

Sources sources_of(const Job &job, const std::vector<embed::KernelRow> &rows)
{
  Sources sources{job.folders, {}, {}};
  for (const embed::KernelRow &row : rows)
    (job.features_left_out.contains(row.feature) ? sources.left_out : sources.kept).push_back(row);
  return sources;
}

/* The files that the source is made of are added to `files`. A stage whose kernels are all left out has no program. */
std::string source_of(const Job &job, const Sources &sources, const std::string &folder, std::set<std::string> &files)
{
  Pieces pieces;
  std::ostringstream out;
  for (const std::string &path : job.programs) {
    Program program;
    program.name = std::filesystem::path(path).stem().string();
    expand(sources, path, program);
    files.merge(program.files);
    const std::vector<embed::KernelRow> entries = entries_of(program, sources.kept);
    if (!program.stage.empty() && entries.empty()) {
      if (!entries_of(program, sources.left_out).empty()) continue;
      throw std::runtime_error(program.name + ".cl: " + job.list_name + " has no kernel of stage " + program.stage);
    }
    write_program(program, entries, job.list_name, folder, pieces, out);
  }
  const std::string result = "const std::vector<tandem::EmbeddedProgram> &" + job.function + "()";
  return "/* Generated by embed_kernels: do not edit. */\n#include \"host/runtime/interface/embedded_program.h\"\n\n"
         "namespace " +
         job.name_space + " {\nnamespace {\n" + pieces.variables() + "} // namespace\n\nextern " + result + ";\n" +
         result + "\n{\nstatic const std::vector<tandem::EmbeddedProgram> programs = {\n" + out.str() +
         "};\nreturn programs;\n}\n} // namespace " + job.name_space + '\n';
}

/* A rule of make, with blanks in names escaped by backslashes. */
std::string rule_of(const std::string &target, const std::set<std::string> &files)
{
  const auto escaped = [](const std::string &path) {
    std::string text;
    for (const char c : path) text += c == ' ' ? std::string("\\ ") : std::string(1, c);
    return text;
  };
  std::string rule = escaped(target) + ":";
  for (const std::string &file : files) {
    rule += ' ';
    rule += escaped(file);
  }
  return rule + "\n";
}

void write_file(const std::string &path, const std::string &text)
{
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

} // namespace

int main(int count, char **arguments)
try {
  if (count < 4)
    throw std::runtime_error(
        "usage: embed_kernels ROOT FOLDER [--without FEATURE,...] cl/NAME.cl ...; or ROOT FOLDER --module NAME SOURCES "
        "KERNELS BUFFERS NAME.cl");
  const Job job = job_of({arguments + 1, arguments + count});
  const std::vector<embed::KernelRow> rows = embed::kernel_rows(job.lists);
  check_stages(rows, job);
  std::set<std::string> files{job.lists.kernels, job.lists.root + "/shared/buffers.def",
                              job.lists.root + "/shared/argument_groups.h"};
  if (!job.lists.buffers.empty()) files.insert(job.lists.buffers);
  write_file(job.written, source_of(job, sources_of(job, rows), arguments[2], files));
  write_file(job.written + ".d", rule_of(job.written, files));
} catch (const std::exception &error) {
  std::cerr << "embed_kernels: " << error.what() << '\n';
  return 1;
}
