/* command_line.h - runs the real program as a script would, for the tests of the command. */
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/catch.h"

namespace command_line {

using Json = nlohmann::json;
namespace files = std::filesystem;

/* A directory of its own, which is removed when the test ends. */
struct Scratch {
  files::path path;
  Scratch()
  {
    std::string pattern = (files::temp_directory_path() / "tandem-command-XXXXXX").string();
    path = mkdtemp(pattern.data());
  }
  ~Scratch() { files::remove_all(path); }
  std::string file(const std::string &name) const { return (path / name).string(); }
};

inline std::string contents(const std::string &path)
{
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

struct Result {
  int status;
  std::string out, error;
};

/* A sanitizer tree borrows the objects of these tests and names its own command. */
inline std::string program()
{
  const char *given = std::getenv("TANDEM_COMMAND");
  return given ? given : TANDEM_COMMAND;
}

/* The result of a command line in the shell. */
inline Result shell(const std::string &line)
{
  const Scratch scratch;
  const std::string error = scratch.file("error");
  std::FILE *pipe = popen(("(" + line + ") 2>'" + error + "'").c_str(), "r");
  REQUIRE(pipe);
  std::string out;
  char buffer[4096];
  for (size_t size; (size = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) out.append(buffer, size);
  const int status = pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, out, contents(error)};
}

/* `environment` stands before the program: "A=1 B=2". */
inline Result command(const std::string &arguments, const std::string &environment = "")
{
  return shell(environment + " '" + program() + "' " + arguments);
}

inline void check_refused(const std::string &arguments, const std::string &mentions,
                          const std::string &environment = "")
{
  const Result result = command(arguments, environment);
  INFO(arguments << "\nstdout: " << result.out << "\nstderr: " << result.error);
  CHECK(result.status == 2);
  CHECK(std::count(result.error.begin(), result.error.end(), '\n') == 1);
  CHECK(result.error.find("tandem: ") == 0);
  CHECK(result.error.find(mentions) != std::string::npos);
  CHECK(result.out.empty());
}

inline Json json_of(const std::string &arguments, int status = 0)
{
  const Result result = command(arguments + " --json -");
  INFO(arguments << "\nstdout: " << result.out << "\nstderr: " << result.error);
  REQUIRE(result.status == status);
  return Json::parse(result.out);
}

inline void check_keys(const Json &json, const std::vector<std::string> &keys)
{
  for (const std::string &key : keys) {
    INFO(key);
    CHECK(json.contains(key));
  }
}

} // namespace command_line
