/* data.cpp - writes CSV and JSON; see data.h. */
#include "tools/report/data.h"

#include <cmath>

#include <fmt/format.h>

namespace tandem {
namespace {

/* Numbers are written so that they are read back exactly; a number that is not finite is empty in CSV and null in
 * JSON. */
std::string csv_number(double value) { return std::isfinite(value) ? fmt::format("{:.17g}", value) : ""; }
Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string csv_text(const std::string &text)
{
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::string csv_row(const std::string &scene, const Run &run)
{
  std::string row = fmt::format("{},{},{},{},{},{},{},{},{}", csv_text(scene), run.solver, csv_text(run.backend),
                                run.settings.substeps, run.settings.iterations, csv_number(double{run.settings.step}),
                                run.steps, csv_number(run.step_milliseconds), csv_number(run.cost()));
  for (const double error : run.errors) row += "," + csv_number(error);
  row += fmt::format(",{},{},{},{},{},{},{},{},{}\n", csv_number(run.position_max), csv_number(run.rotation_max),
                     csv_number(run.mean_height_error), csv_number(run.momentum_drift),
                     csv_number(run.angular_momentum_drift), run.quarantined, hash_text(run.hash), run.front ? 1 : 0,
                     csv_text(run.failure));
  return row;
}

Json run_json(const Run &run)
{
  Json json = {{"solver", run.solver},
               {"backend", run.backend},
               {"substeps", run.settings.substeps},
               {"iterations", run.settings.iterations},
               {"dt", run.settings.step},
               {"steps", run.steps},
               {"ms_per_step", json_number(run.step_milliseconds)},
               {"ms_per_60th", json_number(run.cost())}};
  for (const MetricName &metric : metric_names()) json[metric.name] = json_number(run.error(metric.metric));
  json["position_max"] = json_number(run.position_max);
  json["rotation_max"] = json_number(run.rotation_max);
  json["mean_height_error"] = json_number(run.mean_height_error);
  json["momentum_drift"] = json_number(run.momentum_drift);
  json["angular_momentum_drift"] = json_number(run.angular_momentum_drift);
  json["nonfinite"] = run.quarantined;
  json["body_hash"] = hash_text(run.hash);
  json["front"] = run.front;
  json["errors_from"] = run.observed_on.empty() ? Json(nullptr) : Json(run.observed_on);
  json["unequal"] = run.unequal;
  json["failure"] = run.failure.empty() ? Json(nullptr) : Json(run.failure);
  return json;
}

/* The runs of all backends in one list; `picks` are indices within their backend. */
Json runs_json(const SceneReport &scene)
{
  Json list = Json::array();
  for (const BackendRuns &each : scene.backends)
    for (const Run &run : each.runs) list.push_back(run_json(run));
  return list;
}

Json picks_json(const SceneReport &scene)
{
  Json list = Json::array();
  for (const BackendRuns &each : scene.backends) {
    Json picks = Json::array();
    for (const Pick &pick : each.picks) picks.push_back({{"wished", pick.target_error}, {"run", pick.run}});
    list.push_back({{"backend", each.backend},
                    {"sentence", pick_sentence(each.runs, each.picks, scene.metric)},
                    {"picks", picks}});
  }
  return list;
}

Json equal_error_json(const SceneReport &scene)
{
  Json list = Json::array();
  for (const EqualError &row : scene.equal_errors)
    for (size_t k = 0; k < row.runs.size(); ++k) {
      const Run *run = row.runs[k] ? &scene.backends[k].runs[*row.runs[k]] : nullptr;
      list.push_back({{"error", row.error},
                      {"solver", row.solver},
                      {"backend", scene.backends[k].backend},
                      {"ms_per_60th", run ? json_number(run->cost()) : Json(nullptr)},
                      {"setting", run ? Json(short_text(run->settings)) : Json(nullptr)}});
    }
  return list;
}

Json truth_json(const Truth &truth)
{
  Json refinement = Json::array();
  for (int k = 0; k < 3; ++k)
    refinement.push_back({{"steps_per_60th", truth.refinements[k]},
                          {"position", json_number(truth.refinement_errors[k].position_rms())},
                          {"rotation", json_number(truth.refinement_errors[k].angle_rms())}});
  return {{"closed_form", truth.closed_form},
          {"horizon", truth.horizon},
          {"chaotic", truth.chaotic},
          {"resolved", truth.resolved},
          {"nudge", truth.nudge},
          {"frames", truth.frames.size()},
          {"compared", truth.comparable_frames},
          {"refinement", refinement},
          {"order", truth.order ? json_number(*truth.order) : Json(nullptr)}};
}

Json scene_json(const SceneReport &scene)
{
  return {{"name", scene.source->name},
          {"scene", scene.specification},
          {"duration", scene.duration},
          {"metric", name_of(scene.metric).name},
          {"unit", name_of(scene.metric).unit},
          {"uncertainty", json_number(scene.uncertainty())},
          {"truth", scene.truth.known() ? truth_json(scene.truth) : Json(nullptr)},
          {"backends", picks_json(scene)},
          {"equal_error", equal_error_json(scene)},
          {"runs", runs_json(scene)}};
}

Json rounding_json(const RoundingTable &table)
{
  Json rows = Json::array(), decisions = Json::array();
  for (const RoundingRow &row : table.rows)
    rows.push_back({{"kernel", row_of(row.kernel).name},
                    {"buffer", row_of(row.buffer).name},
                    {"field", row.field},
                    {"numbers", row.numbers},
                    {"median_ulps", row.median_ulps},
                    {"p999_ulps", row.high_ulps},
                    {"max_ulps", row.max_ulps},
                    {"max_field_ulps", row.max_field_ulps},
                    {"max_relative", json_number(row.max_relative)},
                    {"max_absolute", json_number(row.max_absolute)},
                    {"nonfinite", row.nonfinite}});
  for (const DecisionRow &row : table.decisions)
    decisions.push_back({{"kernel", row_of(row.kernel).name},
                         {"buffer", row_of(row.buffer).name},
                         {"numbers", row.numbers},
                         {"differing", row.differing}});
  return {{"launches", table.launches}, {"rows", rows}, {"integers", decisions}};
}

Json curves_json(const std::vector<ContactCurve> &curves)
{
  Json list = Json::array();
  for (const ContactCurve &curve : curves) {
    Json points = Json::array();
    for (const ContactCurve::Point &point : curve.points)
      points.push_back({{"ms", point.milliseconds}, {"residual", json_number(point.residual)}});
    list.push_back({{"problem", curve.problem}, {"solver", curve.solver}, {"points", points}});
  }
  return list;
}

Json joints_json(const JointReport &joints)
{
  Json curves = Json::array();
  for (const JointCurve &curve : joints.curves) {
    Json points = Json::array();
    for (const JointCurve::Point &point : curve.points)
      points.push_back({{"substeps", point.substeps}, {"error", json_number(point.error)}});
    curves.push_back({{"scene", curve.scene},
                      {"method", curve.method},
                      {"order", curve.order() ? Json(*curve.order()) : Json(nullptr)},
                      {"points", points}});
  }
  return {{"uncertainty", json_number(joints.uncertainty)}, {"curves", curves}};
}

} // namespace

std::string report_csv(const Report &report)
{
  std::string text = "scene,solver,backend,substeps,iterations,dt,steps,ms_per_step,ms_per_60th";
  for (const MetricName &metric : metric_names()) text += fmt::format(",{}", metric.name);
  text += ",position_max,rotation_max,mean_height_error,momentum_drift,angular_momentum_drift,nonfinite,body_hash,"
          "front,failure\n";
  for (const SceneReport &scene : report.scenes)
    for (const BackendRuns &each : scene.backends)
      for (const Run &run : each.runs) text += csv_row(scene.specification, run);
  return text;
}

Json report_json(const Report &report)
{
  Json scenes = Json::array();
  for (const SceneReport &scene : report.scenes) scenes.push_back(scene_json(scene));
  return {{"command", report.request.command},
          {"quick", report.request.quick},
          {"date", report.date},
          {"machine", report.machine},
          {"backends", report.request.backends},
          {"solvers", report.request.solvers},
          {"estimate", report.estimate},
          {"scenes", scenes},
          {"contact_problems", curves_json(report.contact_curves)},
          {"joints", joints_json(report.joints)},
          {"rounding",
           {{"scene", report.rounding.scene},
            {"far", report.rounding.far},
            {"near", rounding_json(report.rounding.candidate_table)},
            {"moved", rounding_json(report.rounding.far_table)}}}};
}

} // namespace tandem
