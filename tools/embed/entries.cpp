/* entries.cpp - writes entries in readable form: lines of at most 120 columns, with the names of the row; see
 * entries.h. */
#include "tools/embed/entries.h"

namespace embed {
namespace {

/* Joins pieces by commas between an opening and a closing text, with every line but the first indented. */
std::string wrapped(const std::string &opening, const std::vector<std::string> &pieces, const std::string &closing)
{
  const size_t columns = 120;
  std::string text = opening, line = opening;
  for (size_t i = 0; i < pieces.size(); ++i) {
    const std::string piece = pieces[i] + (i + 1 < pieces.size() ? "," : closing);
    const bool fits = line.size() + 1 + piece.size() <= columns;
    const std::string between = i == 0 ? "" : fits ? " " : "\n    ";
    line = fits ? line + between + piece : "    " + piece;
    text += between + piece;
  }
  return text;
}

std::string declared(const Parameter &parameter)
{
  switch (parameter.kind) {
  case Parameter::Kind::read: return "__global const " + parameter.type + " *" + parameter.name;
  case Parameter::Kind::written: return "__global " + parameter.type + " *" + parameter.name;
  case Parameter::Kind::value: break;
  }
  return parameter.type + " " + parameter.name;
}

/* An argument of the shared function, with this text for each of its parameters. */
std::string passed(const FunctionArgument &argument, const std::vector<std::string> &texts)
{
  if (argument.group_type.empty()) return texts.front();
  std::string text = "(" + argument.group_type + "){";
  for (size_t i = 0; i < argument.members.size(); ++i)
    text += (i ? ", ." : ".") + argument.members[i] + " = " + texts[i];
  return text + "}";
}

std::vector<std::string> names_of(const std::vector<Parameter> &parameters)
{
  std::vector<std::string> names;
  for (const Parameter &parameter : parameters) names.push_back(parameter.name);
  return names;
}

std::string numbered(const Parameter &parameter, size_t number)
{
  const std::string place = "$" + std::to_string(number);
  if (parameter.kind == Parameter::Kind::value) return place;
  return (parameter.kind == Parameter::Kind::read ? "(__global const " : "(__global ") + parameter.type + " *)" + place;
}

} // namespace

std::string entry_of(const KernelRow &row, const std::string &list)
{
  std::vector<std::string> parameters, arguments;
  for (const FunctionArgument &argument : row.arguments) {
    for (const Parameter &parameter : argument.parameters) parameters.push_back(declared(parameter));
    arguments.push_back(passed(argument, names_of(argument.parameters)));
  }
  parameters.push_back("RANGE");
  const bool is_group = has_groups(row);
  if (is_group) arguments.push_back("local_memory");
  arguments.push_back(is_group ? "GROUP_NUMBER" : "i");

  std::string text = "#line " + std::to_string(row.line) + " \"" + list + "\"\n";
  text += wrapped("__kernel void " + row.name + "(", parameters, ")\n{\n");
  if (is_group) text += "  __local uint local_memory[" + row.local_words + "];\n";
  else text += "  FOR_EACH_IN_RANGE(i)\n";
  text += wrapped("  " + row.name + (is_group ? "_group(" : "_item("), arguments, ");\n");
  return text + (is_group ? "  END_GROUP;\n}\n" : "}\n");
}

std::string call_of(const KernelRow &row)
{
  const bool is_group = has_groups(row);
  std::string text = row.name + (is_group ? "_group(" : "_item(");
  size_t number = 0;
  for (const FunctionArgument &argument : row.arguments) {
    std::vector<std::string> texts;
    for (const Parameter &parameter : argument.parameters) texts.push_back(numbered(parameter, number++));
    text += passed(argument, texts) + ", ";
  }
  return text + (is_group ? "local_memory, group)" : "i)");
}

} // namespace embed
