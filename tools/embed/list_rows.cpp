/* list_rows.cpp - parses calls of macros, NAME(first, second, ...), in the lists of shared/; see list_rows.h. */
#include "tools/embed/list_rows.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

namespace embed {
namespace {

struct Call {
  std::string name;
  std::vector<std::string> arguments;
  int line;
};

std::string read_file(const std::string &path)
{
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot read " + path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/* Replaces comments by blanks, so that lines keep their numbers. */
std::string without_comments(std::string text)
{
  for (size_t at = text.find("/*"); at != text.npos; at = text.find("/*", at)) {
    const size_t end = std::min(text.find("*/", at), text.size() - 2) + 2;
    for (; at < end; ++at)
      if (text[at] != '\n') text[at] = ' ';
  }
  return text;
}

/* Removes directives and their continuation lines. */
std::string without_directives(const std::string &text)
{
  std::istringstream in(text);
  std::string kept, line;
  for (bool is_directive = false, continues = false; std::getline(in, line);
       kept += is_directive ? "\n" : line + '\n') {
    const size_t first = line.find_first_not_of(" \t");
    is_directive = continues || (first != line.npos && line[first] == '#');
    continues = is_directive && line.ends_with('\\');
  }
  return kept;
}

std::string trimmed(const std::string &text)
{
  const size_t first = text.find_first_not_of(" \t\n\\"), last = text.find_last_not_of(" \t\n\\");
  return first == text.npos ? std::string{} : text.substr(first, last - first + 1);
}

bool is_of_a_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

/* Parses arguments from after an opening parenthesis to after the closing one; commas and parentheses in strings do not
 * count. */
std::vector<std::string> arguments_from(const std::string &text, size_t &at)
{
  std::vector<std::string> arguments(1);
  bool in_string = false;
  for (int depth = 1; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"') in_string = !in_string;
    if (!in_string && c == '(') ++depth;
    if (!in_string && c == ')' && --depth == 0) break;
    if (!in_string && c == ',' && depth == 1) arguments.emplace_back();
    else arguments.back() += c;
  }
  if (at == text.size()) throw std::runtime_error("a parenthesis stays open in: " + text.substr(0, 60));
  ++at;
  for (std::string &argument : arguments) argument = trimmed(argument);
  return arguments;
}

std::vector<Call> calls_in(const std::string &text)
{
  std::vector<Call> calls;
  for (size_t at = 0; (at = text.find('(', at)) != text.npos;) {
    size_t begin = at;
    while (begin > 0 && is_of_a_name(text[begin - 1])) --begin;
    const int line = 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(begin), '\n'));
    const std::string name = text.substr(begin, at - begin);
    calls.push_back({name, arguments_from(text, ++at), line});
  }
  return calls;
}

/* The name in OpenCL C of an element type of buffers.def. */
std::string type_of_element(const std::string &element) { return element == "real" ? "memory_real" : element; }

void read_buffer_types(const std::string &list, std::map<std::string, std::string> &types)
{
  for (const Call &row : calls_in(without_directives(without_comments(read_file(list))))) {
    if (row.name != "BUFFER" || row.arguments.size() != 7)
      throw std::runtime_error(list + ":" + std::to_string(row.line) +
                               ": not a row of a buffer, BUFFER(name, element, "
                               "capacity, elements per item, feature, lifetime, \"fields\")");
    types[row.arguments[0]] = type_of_element(row.arguments[1]);
    const bool has_two_sides = row.arguments[5] == "STATE" || row.arguments[5] == "CACHE";
    if (has_two_sides) types["previous_" + row.arguments[0]] = types[row.arguments[0]];
  }
}

std::map<std::string, std::string> buffer_types(const Lists &lists)
{
  std::map<std::string, std::string> types;
  read_buffer_types(lists.root + "/shared/buffers.def", types);
  if (!lists.buffers.empty()) read_buffer_types(lists.buffers, types);
  return types;
}

struct Member {
  std::string buffer, name;
};

/* Parses #define GROUP_name(BUFFER) BUFFER(buffer, type, member) ... */
std::map<std::string, std::vector<Member>> argument_groups(const std::string &root)
{
  std::map<std::string, std::vector<Member>> groups;
  const std::string text = without_comments(read_file(root + "/shared/argument_groups.h")), define = "#define GROUP_";
  for (size_t at = 0; (at = text.find(define, at)) != text.npos;) {
    const size_t name = at + define.size(), open = text.find('(', name);
    size_t end = text.find('\n', open);
    while (end != text.npos && text[end - 1] == '\\') end = text.find('\n', end + 1);
    size_t body = text.find(')', open) + 1;
    std::vector<Member> &members = groups[text.substr(name, open - name)];
    for (const Call &call : calls_in(text.substr(body, end - body)))
      members.push_back({call.arguments.at(0), call.arguments.at(2)});
    at = end;
  }
  return groups;
}

class Rows {
public:
  explicit Rows(const Lists &lists) : types_(buffer_types(lists)), groups_(argument_groups(lists.root)) {}

  KernelRow row_from(const Call &call) const
  {
    if (call.name != "KERNEL" || call.arguments.size() != 6) throw std::runtime_error("not a row of a kernel");
    KernelRow row{call.arguments[0], call.arguments[1], call.arguments[2], call.arguments[4], {}, {}, call.line};
    for (const Call &argument : calls_in(call.arguments[5]))
      if (argument.name == "LOCAL_MEMORY") row.local_words = argument.arguments.at(0);
      else row.arguments.push_back(argument_from(argument));
    if (has_groups(row) == row.local_words.empty())
      throw std::runtime_error(
          "kernel " + row.name +
          ": LOCAL_MEMORY belongs to each kernel of execution GROUP or LANES_GROUP, and to no other");
    return row;
  }

private:
  FunctionArgument argument_from(const Call &call) const
  {
    const std::string &first = call.arguments.at(0);
    if (call.name == "VALUE") return alone({Parameter::Kind::value, "uint", first});
    if (call.name == "IN") return alone({Parameter::Kind::read, type_of(first), first});
    if (call.name == "OUT" || call.name == "INOUT") return alone({Parameter::Kind::written, type_of(first), first});
    if (call.name == "SLOT_IN") return alone({Parameter::Kind::read, type_of_element(first), call.arguments.at(1)});
    if (call.name == "SLOT_OUT" || call.name == "SLOT_INOUT")
      return alone({Parameter::Kind::written, type_of_element(first), call.arguments.at(1)});
    if (call.name == "IN_GROUP") return group(Parameter::Kind::read, "read_" + first, first);
    if (call.name == "OUT_GROUP" || call.name == "INOUT_GROUP")
      return group(Parameter::Kind::written, "write_" + first, first);
    throw std::runtime_error("'" + call.name + "' is no kind of argument");
  }

  static FunctionArgument alone(const Parameter &parameter) { return {{}, {}, {parameter}}; }

  FunctionArgument group(Parameter::Kind kind, const std::string &type, const std::string &name) const
  {
    const auto found = groups_.find(name);
    if (found == groups_.end()) throw std::runtime_error("shared/argument_groups.h has no GROUP_" + name);
    FunctionArgument argument{type, {}, {}};
    for (const Member &member : found->second) {
      argument.members.push_back(member.name);
      argument.parameters.push_back({kind, type_of(member.buffer), member.buffer});
    }
    return argument;
  }

  const std::string &type_of(const std::string &buffer) const
  {
    const auto found = types_.find(buffer);
    if (found == types_.end()) throw std::runtime_error("no list of buffers has '" + buffer + "'");
    return found->second;
  }

  std::map<std::string, std::string> types_;
  std::map<std::string, std::vector<Member>> groups_;
};

} // namespace

std::vector<KernelRow> kernel_rows(const Lists &lists)
{
  const Rows rows(lists);
  std::vector<KernelRow> kernels;
  for (const Call &call : calls_in(without_directives(without_comments(read_file(lists.kernels))))) try {
      kernels.push_back(rows.row_from(call));
    } catch (const std::exception &error) {
      throw std::runtime_error(lists.kernels + ":" + std::to_string(call.line) + ": " + error.what());
    }
  return kernels;
}

} // namespace embed
