/* report.cpp - `tandem report`: error against run time, for every solver, as a page that opens offline. */
#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/io/contact_problem/file.h"
#include "host/runtime/backend_list.h"
#include "tools/command/command.h"
#include "tools/command/output.h"
#include "tools/report/contact_curves.h"
#include "tools/report/data.h"
#include "tools/report/report_page.h"

namespace tandem {
namespace {

struct ReportOptions {
  bool quick = false;
  std::string scenes, solvers, parts, on = "tbb,serial", metric, problems, out;
  JsonOutput json;
};

constexpr const char *part_names[] = {"scenes", "problems", "joints", "rounding"};

std::string case_names()
{
  std::string names;
  for (const ReportCase &report_case : report_cases())
    names += (names.empty() ? "" : ", ") + std::string(report_case.name);
  return names;
}

std::string metric_list()
{
  std::string names;
  for (const MetricName &metric : metric_names()) names += (names.empty() ? "" : ", ") + std::string(metric.name);
  return names;
}

void add_options(CLI::App &parser, ReportOptions &options)
{
  parser
      .add_option("--out", options.out, "folder for report.html, report.csv and report.json; made if it is not there")
      ->type_name("DIR")
      ->required();
  parser.add_flag("--quick", options.quick, "small scenes and few settings: under two minutes on two cores");
  parser.add_option("--scenes", options.scenes, "some of: " + case_names())->type_name("NAME,NAME,...");
  parser.add_option("--solvers", options.solvers, fmt::format("some of: {}", fmt::join(choice_names<Solver>(), ", ")))
      ->type_name("NAME,NAME,...");
  parser.add_option("--on", options.on, "every scene on each of these; contact problems and joints on the first")
      ->type_name("B,B,...")
      ->capture_default_str();
  parser.add_option("--parts", options.parts, fmt::format("some of: {} (default: all)", fmt::join(part_names, ", ")))
      ->type_name("PART,PART,...");
  parser
      .add_option("--metric", options.metric, "one error for all scenes instead of each scene's own: " + metric_list())
      ->type_name("NAME");
  parser
      .add_option("--problems", options.problems,
                  "files for contact-problem (default: those of tests/scenes and data/siconos, if they are there)")
      ->type_name("FILE,FILE,...");
  parser.add_option("--json", options.json.path, "write report.json here too; - for standard output")
      ->type_name("FILE");
}

std::vector<std::string> list_of(const std::string &option, const std::string &text)
{
  std::vector<std::string> names;
  std::istringstream stream(text + ",");
  for (std::string name; std::getline(stream, name, ',');) {
    if (name.empty())
      throw InputError(fmt::format("{} '{}': nothing between two commas, or at an end of the list", option, text));
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

std::vector<std::string> solvers_of(const std::string &text)
{
  const std::vector<std::string> known = choice_names<Solver>();
  if (text.empty()) return known;
  const std::vector<std::string> wanted = list_of("--solvers", text);
  for (const std::string &solver : wanted)
    if (std::find(known.begin(), known.end(), solver) == known.end())
      throw InputError(fmt::format("--solvers: unknown solver '{}'; solvers: {}", solver, fmt::join(known, ", ")));
  return wanted;
}

std::string typed(const ReportOptions &options)
{
  std::string command = "tandem report";
  if (options.quick) command += " --quick";
  const auto add = [&](const char *name, const std::string &value) {
    if (!value.empty()) command += fmt::format(" {} {}", name, value);
  };
  add("--scenes", options.scenes);
  add("--solvers", options.solvers);
  add("--parts", options.parts);
  add("--on", options.on);
  add("--metric", options.metric);
  add("--problems", options.problems);
  add("--out", options.out);
  return command;
}

std::vector<std::string> parts_of(const std::string &text)
{
  const std::vector<std::string> known(std::begin(part_names), std::end(part_names));
  if (text.empty()) return known;
  const std::vector<std::string> wanted = list_of("--parts", text);
  for (const std::string &part : wanted)
    if (std::find(known.begin(), known.end(), part) == known.end())
      throw InputError(fmt::format("--parts: unknown part '{}'; parts: {}", part, fmt::join(known, ", ")));
  return wanted;
}

std::vector<const ReportCase *> cases_of(const ReportOptions &options)
{
  std::vector<const ReportCase *> cases;
  if (options.scenes.empty()) {
    for (const ReportCase &report_case : report_cases())
      if (!options.quick || report_case.quick_scene) cases.push_back(&report_case);
    return cases;
  }
  for (const std::string &name : list_of("--scenes", options.scenes)) {
    const ReportCase &report_case = report_case_named(name);
    if (options.quick && !report_case.quick_scene)
      throw InputError(fmt::format("--scenes: {} is too large for --quick; leave one of them out", name));
    cases.push_back(&report_case);
  }
  return cases;
}

ReportRequest request_of(const ReportOptions &options)
{
  ReportRequest request;
  request.quick = options.quick;
  request.solvers = solvers_of(options.solvers);
  request.backends = split_backends(options.on);
  if (!options.metric.empty()) request.metric = metric_named(options.metric);
  const std::vector<std::string> parts = parts_of(options.parts);
  const auto wanted = [&](const char *part) { return std::find(parts.begin(), parts.end(), part) != parts.end(); };
  if (wanted("scenes")) request.cases = cases_of(options);
  request.with_problems = wanted("problems");
  request.with_joints = wanted("joints");
  request.with_rounding = wanted("rounding");
  if (request.with_problems)
    request.problems =
        options.problems.empty() ? usual_contact_problems(options.quick) : list_of("--problems", options.problems);
  for (const std::string &file : request.problems)
    read_contact_problem(file); /* reports a bad file before anything runs */
  request.command = typed(options);
  return request;
}

/* A folder that cannot be written is refused before minutes are spent on results. */
void prepare_folder(const std::string &folder, DistinctFiles &files)
{
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw InputError(fmt::format("--out {}: cannot make this folder: {}", folder,
                                 error ? error.message() : "a file of this name is there"));
  for (const char *name : {"report.html", "report.csv", "report.json"})
    files.writes("--out", (std::filesystem::path(folder) / name).string());
}

void write_report(const Report &report, const ReportOptions &options)
{
  const auto file = [&](const char *name) { return (std::filesystem::path(options.out) / name).string(); };
  const Json json = report_json(report);
  write_file("--out", file("report.html"), report_page(report));
  write_file("--out", file("report.csv"), report_csv(report));
  write_file("--out", file("report.json"), json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  options.json.write(json);
  if (options.json.takes_standard_output()) return;
  for (const SceneReport &scene : report.scenes)
    for (const BackendRuns &each : scene.backends)
      fmt::print("{} on {}: {}\n", scene.source->name, each.backend,
                 pick_sentence(each.runs, each.picks, scene.metric));
  for (const JointCurve &curve : report.joints.curves)
    fmt::print("{} in {}: {}\n", curve.scene, curve.method, order_sentence(curve));
  fmt::print("\n{} (charts and tables), report.csv and report.json beside it\n", file("report.html"));
}

int execute(const ReportOptions &options)
{
  const ReportRequest request = request_of(options);
  DistinctFiles files;
  for (const std::string &file : request.problems) files.reads("--problems", file);
  prepare_folder(options.out, files);
  options.json.check(files);
  const Report report = collect_report(request);
  write_report(report, options);
  if (report.unequal() == 0) return 0;
  fmt::print(stderr,
             "tandem: {} runs do not end in the bits of the backend they are compared with; report.html names them\n",
             report.unequal());
  return 1;
}

} // namespace

Command report_command(CLI::App &parser)
{
  CLI::App *command = parser.add_subcommand("report", "error against run time for every solver, as a page of charts");
  auto options = std::make_shared<ReportOptions>();
  add_options(*command, *options);
  return {command, [options] { return execute(*options); }};
}

} // namespace tandem
