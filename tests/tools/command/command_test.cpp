/* command_test.cpp - the real program, run as a script would: one line and status 2 for any error, and the promised
 * keys otherwise. */
#ifdef TANDEM_COMMAND
#include <regex>
#include <set>

#include <sys/stat.h>

#include "tests/tools/command/command_line.h"

using namespace command_line;

namespace {

const std::string tiny = "box-grid:nx=2,ny=2,nz=2";

} // namespace

TEST_CASE("command: unknown commands and options", "[command]")
{
  check_refused("", "--help");
  check_refused("fly", "fly");
  check_refused("--fly", "--fly");
  check_refused("run", "SCENE");
  check_refused("run " + tiny + " --sideways", "--sideways");
  check_refused("run " + tiny + " --steps", "--steps");
  check_refused("run " + tiny + " extra", "extra");
  check_refused("bench", "WHAT");
  check_refused("bench juggling", "juggling");
}

TEST_CASE("command: numbers out of range", "[command]")
{
  for (const char *steps : {"0", "-1", "many", "1.5", "99999999999999999999"})
    check_refused("run " + tiny + " --steps " + steps, "--steps");
  for (const char *step : {"-0.1", "0", "nan", "inf", "soon", "1/0", "1e9"})
    check_refused("run " + tiny + " --dt " + step, "");
  check_refused("run " + tiny + " --dt nan", "--dt");
  check_refused("run " + tiny + " --substeps 0", "--substeps '0': use a whole number from 1 to 1000, or auto");
  check_refused("run " + tiny + " --iterations 1001", "--iterations");
  check_refused("bench sort --n 0", "--n");
}

TEST_CASE("command: names that do not exist", "[command]")
{
  check_refused("run castle", "castle");
  check_refused("run box-grid:bricks=3", "bricks");
  check_refused("run box-grid:nx=none", "nx");
  check_refused("run " + tiny + " --midphase forest", "walk, subtrees");
  check_refused("run " + tiny + " --on gpu", "gpu");
  check_refused("run " + tiny + " --on tbb:lanes=3", "lanes");
  check_refused("run " + tiny + " --on tbb:lanes=4,threads=2,lanes=8", "lanes is given twice");
  check_refused("run " + tiny + " --image-size 64x64", "--image");
  check_refused("run " + tiny + " --camera 1,1,1,0,0,0", "--image");
  check_refused("run " + tiny + " --on cl:nothing-of-this-name", "nothing-of-this-name");
  check_refused("run " + tiny + " --solver magic", "magic");
  check_refused("run " + tiny + " --broadphase magic", "magic");
  check_refused("run " + tiny + " --narrowphase magic", "magic");
  check_refused("run " + tiny + " --batching magic", "magic");
  check_refused("run " + tiny + " --place nowhere=serial", "nowhere");
  check_refused("run " + tiny + " --place solve=gpu", "gpu");
  check_refused("diff " + tiny + " --between serial", "two");
  check_refused("diff " + tiny + " --between serial,gpu", "gpu");
  check_refused("diff " + tiny + " --plant nothing:bounds:0", "nothing");
}

TEST_CASE("command: scene files that cannot be read", "[command]")
{
  const Scratch scratch;
  check_refused("run " + scratch.file("missing.json"), "missing.json");
  std::ofstream(scratch.file("broken.json")) << "{ \"bodies\": [ }";
  check_refused("run " + scratch.file("broken.json"), "broken.json");
  std::ofstream(scratch.file("broken.glb")) << "not glTF at all";
  check_refused("run " + scratch.file("broken.glb"), "broken.glb");
}

TEST_CASE("command: convert writes a scene of any format, which moves as what it was read from", "[command]")
{
  const Scratch scratch;
  const std::string written = scratch.file("written.json"), again = scratch.file("again.json");
  for (const char *scene : {"arm.urdf", "four_bar.xml", "tilted_box_on_plane.gltf", "three_bodies.json"}) {
    const std::string path = std::string(TANDEM_SOURCE_DIR "/tests/scenes/") + scene;
    CAPTURE(scene);
    CHECK(command("convert " + path + " " + written).status == 0);
    CHECK(command("convert " + written + " " + again).status == 0);
    CHECK(contents(written) == contents(again));
    CHECK(json_of("run " + path + " --steps 30")["hash"] == json_of("run " + written + " --steps 30")["hash"]);
  }
  check_refused("convert castle " + written, "castle");
  check_refused("convert " + written, "file");
  check_refused("convert " + written + " " + written, "written.json");
  check_refused("convert " + tiny + " /nonexistent/file.json", "/nonexistent/file.json");
}

TEST_CASE("command: files that cannot be written are refused before the run", "[command]")
{
  for (const char *option : {"--json", "--save", "--trace", "--events"})
    check_refused("run " + tiny + " --steps 1000000000 " + option + " /nonexistent/file.glb", "/nonexistent/file.glb");
  check_refused("run " + tiny + " --steps 1000000000 --image /nonexistent/file.png", "/nonexistent/file.png");
  check_refused("run " + tiny + " --steps 1000000000 --image picture.jpg", ".png");
  check_refused("run " + tiny + " --steps 1000000000 --image picture.png --camera 1e39,0,0,0,0,1", "--camera");
  check_refused("run " + tiny + " --image picture.png --image-size 0x5", "--image-size");
  check_refused("run " + tiny + " --image picture.png --image-size 640", "WIDTHxHEIGHT");
  check_refused("run " + tiny + " --image picture.png --camera 1,2,3", "EX,EY,EZ");
  check_refused("run " + tiny + " --image picture.png --camera 1,2,3,1,5,3", "straight up");
  check_refused("diff " + tiny + " --json /nonexistent/file", "/nonexistent/file");
  check_refused("devices --json /nonexistent/file", "/nonexistent/file");
}

TEST_CASE("command: checking whether a file can be written leaves it alone", "[command]")
{
  const Scratch scratch;
  std::ofstream(scratch.file("kept.json")) << "kept";
  check_refused("run castle --json " + scratch.file("kept.json") + " --save " + scratch.file("new.glb"), "castle");
  CHECK(contents(scratch.file("kept.json")) == "kept");
  CHECK_FALSE(files::exists(scratch.file("new.glb")));
}

TEST_CASE("command: without any OpenCL platform", "[command]")
{
  const Scratch empty;
  const std::string environment = "OCL_ICD_VENDORS=" + empty.path.string() + "/";
  check_refused("run " + tiny + " --on cl", "OpenCL", environment);
  const Result devices = command("devices", environment);
  CHECK(devices.status == 0);
  CHECK(devices.out.find("No OpenCL device") != std::string::npos);
}

TEST_CASE("command: contact problems", "[command]")
{
  const std::string sliding = "contact-problem " TANDEM_SOURCE_DIR "/tests/scenes/contact-sliding.dat";
  for (const char *solver : {"pgs", "nncg", "jacobi", "nsgs"}) {
    const Json json = json_of(sliding + " --tolerance 1e-5 --solver " + solver);
    check_keys(json, {"sweeps", "residual", "ms", "history", "fischer_burmeister", "cone_violation", "impulse"});
    CHECK(json["backend"] == (std::string(solver) == "nsgs" ? "reference" : "tbb"));
    CHECK(json["residual"] <= 1e-5);
    CHECK(json["history"].size() == json["sweeps"]);
    CHECK(json["impulse"][0][2].get<double>() == Approx(0.2).epsilon(1e-4));
  }
  const Json cut_short = json_of(
      "contact-problem " TANDEM_SOURCE_DIR "/tests/scenes/box-on-corners.dat --tolerance 1e-6 --iterations 3", 1);
  CHECK(cut_short["sweeps"] == 3);
  CHECK(cut_short["converged"] == false);
  check_refused("contact-problem", "FILE");
  check_refused("contact-problem nowhere.dat", "nowhere.dat");
  check_refused("contact-problem /", "Is a directory");
  check_refused(sliding + " --solver gauss", "pgs, nncg, jacobi, nsgs");
  check_refused(sliding + " --solver nsgs --on serial", "reference");
  check_refused(sliding + " --tolerance 0", "--tolerance");
  check_refused(sliding + " --tolerance nan", "--tolerance");
  check_refused(sliding + " --iterations 0", "--iterations");
  check_refused(sliding + " --on abacus", "abacus");
  check_refused(sliding + " --json /nowhere/f.json", "--json");
  const Scratch scratch;
  std::ofstream(scratch.file("truncated.dat")) << "3\n1\n0\n3\n3\n3 3\n1 0 0\n";
  check_refused("contact-problem " + scratch.file("truncated.dat"),
                "truncated.dat: line 8: the file ends where W[0][1] should stand");
}

TEST_CASE("command: what is unknown is refused by name", "[command]")
{
  check_refused("joint f", "unknown command 'joint'");
  check_refused("replay f", "f: cannot read");
  check_refused("bench solve", "bench 'solve' is unknown");
}

TEST_CASE("command: stability writes its contract, and says in its status whether the default solver passes",
          "[command]")
{
  const Scratch scratch;
  const std::string out = " --out " + scratch.file("report");
  const Json json = json_of("stability --only flight,gravity-0 --solvers soft-step --on serial" + out);
  REQUIRE(json["cases"].size() == 2);
  for (const Json &each : json["cases"]) check_keys(each, {"name", "solver", "passed", "figure", "bound", "unit"});
  CHECK(json["cases"][1]["name"] == "flight");
  CHECK(json["cases"][1]["passed"] == true);
  for (const char *name : {"index.html", "stability.json", "figures.csv"})
    CHECK(files::file_size(scratch.file("report/") + name) > 100);
  CHECK(Json::parse(contents(scratch.file("report/stability.json"))) == json);
  check_refused("stability --only castle" + out, "castle");
  check_refused("stability --solvers magic" + out, "magic");
  check_refused("stability --on gpu" + out, "gpu");
  check_refused("stability --only flight", "--out");
  check_refused("stability --only flight --out /dev/null/folder", "/dev/null/folder");
  check_refused("stability --only flight --between serial", "two");
  check_refused("stability --groups castles" + out, "the groups are mass ratio");
  check_refused("stability --only flight --except-groups motion" + out, "no case is left");
  const Json chosen = json_of("stability --only flight,gravity-0 --groups motion --solvers soft-step" + out);
  REQUIRE(chosen["cases"].size() == 1);
  CHECK(chosen["cases"][0]["name"] == "flight");
  const std::string listed = command("stability --list --only flight,gravity-0 --groups motion").out;
  CHECK(listed.starts_with("motion\n  flight "));
  CHECK(std::count(listed.begin(), listed.end(), '\n') == 2);
}

TEST_CASE("command: a table of stability goes between the marks of its name", "[command]")
{
  const Scratch scratch;
  const std::string page = scratch.file("page.md"), run = "stability --only pulley-1000 --solvers soft-step --out " +
                                                          scratch.file("report") + " --table-in " + page +
                                                          " --table joints";
  std::ofstream(page) << "<!-- table: begin -->\nother\n<!-- table: end -->\n";
  check_refused(run, "<!-- table joints: begin -->");
  std::ofstream(page, std::ios::app) << "<!-- table joints: begin -->\nold\n<!-- table joints: end -->\n";
  CHECK(command(run).status == 0);
  CHECK(contents(page).find("\nother\n") != std::string::npos);
  CHECK(contents(page).find("\nold\n") == std::string::npos);
  CHECK(contents(page).find("| pulley-1000 |") != std::string::npos);
}

TEST_CASE("command: a stability case has the same bits on OpenCL, also where it fails", "[command]")
{
  if (command("devices").out.find("Portable Computing Language") == std::string::npos) tests::skip_device("no PoCL");
  const Json json = json_of("stability --only heavy-on-light-10000 --solvers soft-step --between serial,tbb,cl:pocl");
  CHECK(json["equal"] == true);
  REQUIRE(json["cases"].size() == 1);
  CHECK(json["cases"][0]["body_hash"].size() == 3);
}

TEST_CASE("command: help and version", "[command]")
{
  CHECK(command("--version").out.find("tandem ") == 0);
  const Result help = command("run --help");
  CHECK(help.status == 0);
  for (const char *said : {"--on", "--place", "--dt", "--midphase", "subtrees", "warm-up", "soft-step"})
    CHECK(help.out.find(said) != std::string::npos);
}

TEST_CASE("command: run writes what its contract says", "[command]")
{
  const Json run = json_of("run " + tiny + " --on serial --steps 20 --substeps 2");
  check_keys(run, {"scene",
                   "backend",
                   "solver",
                   "bodies",
                   "steps",
                   "dt",
                   "step_ms",
                   "stages",
                   "pairs",
                   "contacts",
                   "colors",
                   "max_penetration",
                   "mean_penetration",
                   "kinetic_energy",
                   "nonfinite",
                   "asleep",
                   "islands",
                   "overflow",
                   "memory_bytes",
                   "kernels_built",
                   "build_ms",
                   "hash",
                   "body_hash",
                   "launches",
                   "bytes_moved",
                   "device_reads",
                   "placement"});
  CHECK(run["bytes_moved"] == 0);
  CHECK(run["device_reads"] == 0);
  CHECK(run["placement"]["why"] == "as asked");
  check_keys(run["step_ms"], {"median", "min", "max"});
  CHECK(run["scene"] == tiny);
  CHECK(run["backend"] == "serial");
  CHECK(run["bodies"] == 9);
  CHECK(run["steps"] == 20);
  CHECK(run["step_ms"]["min"] <= run["step_ms"]["median"]);
  CHECK(run["step_ms"]["median"] <= run["step_ms"]["max"]);
  CHECK(run["step_ms"]["min"].get<double>() > 0);
  REQUIRE(run["stages"].size() > 3);
  for (const Json &stage : run["stages"]) check_keys(stage, {"name", "backend", "ms"});
  const std::regex digits("[0-9a-f]{16}");
  CHECK(std::regex_match(run["hash"].get<std::string>(), digits));
  CHECK(std::regex_match(run["body_hash"].get<std::string>(), digits));
}

TEST_CASE("command: a run of one step is timed too", "[command]")
{
  const Json run = json_of("run " + tiny + " --steps 1");
  CHECK(run["step_ms"]["median"].get<double>() > 0);
  CHECK_FALSE(run["stages"].empty());
}

TEST_CASE("command: the hash depends on what is simulated alone", "[command]")
{
  const auto hash = [](const std::string &options) {
    return json_of("run " + tiny + " --steps 12 " + options)["hash"];
  };
  const Json expected = hash("--on serial");
  CHECK(hash("--on tbb:threads=2,lanes=4") == expected);
  CHECK(hash("--on serial --place solve=tbb:threads=1,lanes=4,narrowphase=tbb") == expected);
  CHECK(hash("--dt 1/60") == expected);
  CHECK(hash("--dt 1/50") != expected);
}

TEST_CASE("command: run writes the contact events of each step", "[command]")
{
  const Scratch scratch;
  const Result run = command("run '" TANDEM_SOURCE_DIR "/tests/scenes/triggers.json' --steps 60 --on serial --events " +
                             scratch.file("e.json"));
  REQUIRE(run.status == 0);
  const Json file = Json::parse(contents(scratch.file("e.json")));
  CHECK(file["bodies"].size() == 8);
  std::set<std::pair<int, int>> touching;
  std::set<std::string> kinds;
  int step = 0;
  for (const Json &event : file["events"]) {
    const std::pair<int, int> bodies{event["a"], event["b"]};
    const std::string kind = event["kind"];
    CHECK(bodies.first < bodies.second);
    CHECK(event["step"] >= step);
    step = event["step"];
    kinds.insert(kind + (event["trigger"] ? " trigger" : ""));
    if (kind == "begin") CHECK(touching.insert(bodies).second);
    else if (kind == "persist") CHECK(touching.count(bodies) == 1);
    else CHECK(touching.erase(bodies) == 1);
    if (kind != "end") check_keys(event, {"points", "impulse", "separation", "point", "normal"});
  }
  CHECK(kinds.size() == 6);
  CHECK(step < 60);
}

TEST_CASE("command: run saves an animation and a trace", "[command]")
{
  const Scratch scratch;
  const Result run = command("run " + tiny + " --steps 4 --save " + scratch.file("m.glb") + " --trace " +
                             scratch.file("t.json") + " --json " + scratch.file("r.json"));
  INFO(run.error);
  REQUIRE(run.status == 0);
  CHECK(run.out.find("ms/step") != std::string::npos);
  CHECK(contents(scratch.file("m.glb")).substr(0, 4) == "glTF");
  CHECK(Json::parse(contents(scratch.file("r.json")))["steps"] == 4);
  const Json trace = Json::parse(contents(scratch.file("t.json")));
  int steps = 0, kernels = 0;
  for (const Json &event : trace["traceEvents"]) {
    if (event["ph"] != "X") continue;
    check_keys(event, {"name", "ts", "dur", "pid", "tid"});
    CHECK(event["dur"].get<double>() >= 0);
    steps += event["cat"] == "step";
    kernels += event["name"] == "solve_contacts";
  }
  CHECK(steps == 4);
  CHECK(kernels >= 4 * 8);
}

TEST_CASE("command: diff says equal, or where the first difference is", "[command]")
{
  const Json equal = json_of("diff " + tiny + " --between serial,tbb:threads=2,lanes=4 --steps 3");
  CHECK(equal["equal"] == true);
  CHECK(equal["backends"] == Json({"serial", "tbb:threads=2,lanes=4"}));
  CHECK(equal["steps"] == 3);
  CHECK(equal["kernels_compared"].get<int>() > 3 * 20);
  CHECK(equal["bytes_compared"].get<int64_t>() > 0);
  CHECK(equal["first_difference"].is_null());

  const Json different = json_of("diff " + tiny + " --steps 5 --plant integrate_velocities:solver_velocity:25:2", 1);
  CHECK(different["equal"] == false);
  const Json &first = different["first_difference"];
  CHECK(first["step"] == 2);
  CHECK(first["kernel"] == "integrate_velocities");
  CHECK(first["buffer"] == "solver_velocity");
  CHECK(first["element"] == 6);
  CHECK(first["item"] == 3);
  CHECK(first["field"] == "linear.y");
  CHECK(first["ulps"] == 1);
  CHECK(first["values"].size() == 2);
  CHECK(first["bodies"].size() == 1);
  CHECK(first["gdb"].get<std::string>().find(
            "break integrate_velocities_item if i == 3 && tandem::step_of_launch == 2") != std::string::npos);
}

TEST_CASE("command: lists and plan", "[command]")
{
  const Json devices = json_of("devices");
  REQUIRE(devices["backends"].size() >= 2);
  CHECK(devices["backends"][0]["name"] == "serial");
  CHECK(devices["backends"][1]["name"] == "tbb");
  CHECK(devices["backends"][1]["threads"].get<int>() >= 1);

  const Json scenes = json_of("scenes");
  CHECK(scenes["scenes"].size() >= 6);
  for (const Json &scene : scenes["scenes"]) check_keys(scene, {"name", "description", "parameters"});

  const Json plan = json_of("plan " + tiny);
  check_keys(plan, {"scene", "backend", "features", "flags", "kernels", "kernels_built", "buffers", "memory_bytes",
                    "bytes_a_body", "bytes_a_pair", "room_for_pairs", "build_ms"});
  const auto find = [&](const char *list, const std::string &name) {
    for (const Json &entry : plan[list])
      if (entry["name"] == name) return entry;
    return Json();
  };
  CHECK(find("features", "BOX_BOX")["in"] == true);
  CHECK(find("features", "SPHERE_SPHERE")["in"] == false);
  CHECK(find("kernels", "collide_box_box")["built"] == true);
  CHECK(find("kernels", "collide_sphere_sphere")["built"] == false);
  CHECK(find("buffers", "body_filter")["kept"] == false);
  CHECK(find("buffers", "body_filter")["bytes"].get<int>() > 0);
  int64_t kept = 0;
  for (const Json &buffer : plan["buffers"])
    if (buffer["kept"] == true && buffer["in_memory_of"].is_null()) kept += buffer["bytes"].get<int64_t>();
  CHECK(kept == plan["memory_bytes"].get<int64_t>());
  const double bodies = 9, items = plan["bytes_a_body"].get<double>() * bodies +
                                   plan["bytes_a_pair"].get<double>() * plan["room_for_pairs"].get<double>();
  CHECK(static_cast<int64_t>(items + 0.5) == kept);
  CHECK(find("buffers", "sort_key")["in_memory_of"].is_string());
}

TEST_CASE("command: plan draws what is kept and what is left out", "[command]")
{
  const Scratch scratch;
  const std::string picture = scratch.file("plan.svg");
  const Json plan = json_of("plan spheres:n=8 --svg '" + picture + "'");
  const std::string svg = contents(picture);
  CHECK(svg.find("<svg") == 0);
  for (const Json &kernel : plan["kernels"])
    CHECK(svg.find(">" + kernel["name"].get<std::string>() + "</text>") != std::string::npos);
  CHECK(svg.find("collide_box_box: left out; it comes with BOX_BOX") != std::string::npos);
  CHECK(svg.find("collide_sphere_sphere: on tbb") != std::string::npos);
  CHECK(plan["compiled"].empty());
  check_refused("plan spheres:n=8 --svg /no/such/folder/plan.svg", "--svg");
}

TEST_CASE("command: a placement may be chosen by times, and what moves is counted", "[command]")
{
  const Json chosen = json_of("plan " + tiny + " --place auto");
  CHECK(chosen["placement"]["on"] == "tbb");
  CHECK(chosen["placement"]["settled"] == true);
  CHECK(command("plan " + tiny + " --place auto").out.find("placement: tbb, no OpenCL device is named") !=
        std::string::npos);
  CHECK(json_of("run " + tiny + " --steps 4 --place auto,solve=serial")["placement"]["on"] == "tbb");
  CHECK(json_of("run " + tiny + " --steps 4 --on serial --place solve=reference")["bytes_moved"] > 0);
  check_refused("run " + tiny + " --place automatic", "automatic");
  check_refused("run " + tiny + " --on reference --place auto", "only backends that are exact");
  check_refused("diff " + tiny + " --between serial,tbb --place auto", "--between");
}

TEST_CASE("command: --check proves the batches", "[command]")
{
  const Result fine = command("run box-stack:n=10,height=10 --batching sequential --check --steps 3 --on serial");
  CHECK(fine.status == 0);
  CHECK(fine.out.find("free of conflict in all 3 steps") != std::string::npos);
  const Result wrong =
      command("diff box-stack:n=10,height=10 --batching sequential --check --between serial,tbb --steps 1 "
              "--plant color_in_order:pair_color:8");
  CHECK(wrong.status == 1);
  CHECK(wrong.error.find("tandem: batches wrong in step 0: colour ") != std::string::npos);
  CHECK(wrong.error.find("pairs (4, 3) and (5, 4)") != std::string::npos);
}

TEST_CASE("command: bench batching", "[command]")
{
  const Json bench = json_of("bench batching --n 64 --on serial");
  check_keys(bench, {"what", "backend", "scenes"});
  const Json &scene = bench["scenes"][0];
  check_keys(scene, {"scene", "bodies", "pairs", "contacts", "most_of_body", "longest_chain", "batchers"});
  REQUIRE(scene["batchers"].size() == 6); /* colouring twice */
  /* Contacts of one body are a chain, and along a chain colours grow. */
  CHECK(scene["batchers"][1]["name"] == "coloring, kept");
  CHECK(scene["most_of_body"] <= scene["longest_chain"]);
  CHECK(scene["longest_chain"] <= scene["batchers"][1]["batches"]);
  for (const Json &batcher : scene["batchers"]) {
    uint32_t sum = batcher["tail"];
    for (const Json &size : batcher["sizes"]) sum += size.get<uint32_t>();
    CHECK(sum == scene["contacts"].get<uint32_t>());
    CHECK(batcher["right"] == true);
  }
  /* Two stacks of three boxes: each box stands on another or on the ground. */
  const Json named = json_of("bench batching --scene box-stack:n=6,height=3,spheres:n=2 --steps 5 --on serial");
  REQUIRE(named["scenes"].size() == 2);
  CHECK(named["scenes"][0]["scene"] == "box-stack:n=6,height=3");
  CHECK(named["scenes"][0]["steps"] == 5);
  CHECK(named["scenes"][0]["contacts"] == 6);
  CHECK(named["scenes"][0]["most_of_body"] == 2);
  check_refused("bench batching --steps 5", "--steps");
}

TEST_CASE("command: bench broadphase", "[command]")
{
  const Scratch scratch;
  const Json bench = json_of("bench broadphase --n 300 --on serial --chart " + scratch.file("c.svg"));
  check_keys(bench, {"what", "backend", "timed", "equal", "scenes"});
  CHECK(bench["equal"] == true);
  std::set<std::string> scenes;
  for (const Json &scene : bench["scenes"]) {
    INFO(scene.dump());
    check_keys(scene, {"name", "what", "runs", "slopes"});
    scenes.insert(scene["name"].get<std::string>());
    REQUIRE(scene["runs"].size() >= 6);
    for (const Json &run : scene["runs"]) {
      check_keys(run, {"broadphase", "n", "pairs", "ms", "frames_ms", "skipped", "difference"});
      CHECK(run["n"] == 300);
      CHECK(run["pairs"] == scene["runs"][0]["pairs"]);
      CHECK(run["ms"]["median"].get<double>() > 0);
      check_keys(run["ms"], {"median", "mean", "min", "max"});
      CHECK(run["frames_ms"].size() >= 9);
      CHECK(run["frames_ms"].size() <= 30);
      CHECK(run["skipped"].is_null());
      CHECK(run["difference"].is_null());
      CHECK(scene["slopes"][run["broadphase"].get<std::string>()].is_null()); /* there is one number of bodies alone */
    }
  }
  CHECK(scenes == std::set<std::string>{"spheres", "pile", "one-large", "sizes", "static"});
  CHECK(contents(scratch.file("c.svg")).find("data-name=\"bvh\"") != std::string::npos);
}

TEST_CASE("command: bench sizes beside another run, and what it refuses", "[command]")
{
  const Scratch scratch;
  const std::string other = scratch.file("other.json"), bad = scratch.file("bad.json");
  std::ofstream(other) << R"({"name": "an engine", "sizes": [{"bodies": 8, "ms": {"median": 12.5}}]})";
  const std::string line = "bench sizes --on serial --n 200 --beside " + other;
  const Json bench = json_of(line + " --chart " + scratch.file("c.svg"));
  check_keys(bench, {"what", "name", "sizes"});
  CHECK(bench["name"] == "tandem, serial");
  REQUIRE(bench["sizes"].size() == 2);
  for (const Json &size : bench["sizes"]) {
    check_keys(size, {"bodies", "ms", "max_penetration", "mean_penetration"});
    CHECK(size["ms"]["median"].get<double>() > 0);
    CHECK(size["max_penetration"].get<double>() > 0);
    CHECK(size["max_penetration"].get<double>() < 0.005); /* the slop */
    CHECK(size["mean_penetration"].get<double>() <= size["max_penetration"].get<double>());
  }
  CHECK(bench["sizes"][0]["bodies"] == 8);
  CHECK(bench["sizes"][1]["bodies"] == 125);
  const std::string chart = contents(scratch.file("c.svg"));
  for (const char *name : {"data-name=\"tandem, serial\"", "data-name=\"an engine\""})
    CHECK(chart.find(name) != std::string::npos);
  const std::string table = command(line).out;
  CHECK(table.find("an engine, ms") != std::string::npos);
  CHECK(table.find("12.500") != std::string::npos);
  const Result drawn = command("bench sizes --n 0 --beside " + other + " --chart " + scratch.file("d.svg"));
  CHECK(drawn.status == 0);
  CHECK(drawn.out.find("12.500") != std::string::npos);
  CHECK(contents(scratch.file("d.svg")).find("tandem, ") == std::string::npos);
  check_refused("bench sizes --n 7", "--n");
  check_refused("bench sizes --n 0", "--n");
  check_refused("bench sizes --n 0 --on serial --beside " + other, "--on");
  check_refused("bench sizes --n 0 --beside " + other + " --json -", "--n");
  check_refused("bench sizes --beside /nonexistent/a.json", "/nonexistent/a.json");
  check_refused(line + " --json " + other, "other.json");
  check_refused("bench step --beside " + other, "--beside is of bench sizes");
  const auto row = [](const std::string &fields) { return "{\"name\": \"x\", \"sizes\": [" + fields + "]}"; };
  for (const std::string &text :
       {std::string(), std::string("[]"), std::string(R"({"sizes": []})"), row(R"({"bodies": 8})"),
        row(R"({"bodies": 0, "ms": {"median": 1}})"), row(R"({"bodies": -5, "ms": {"median": 1}})"),
        row(R"({"bodies": 8.9, "ms": {"median": 1}})"), row(R"({"bodies": 8, "ms": {"median": 0}})"),
        row(R"({"bodies": 8, "ms": {"median": 1}, "max_penetration": -5})"),
        row(R"({"bodies": 8, "ms": {"median": 1}, "mean_penetration": 1e308})"),
        std::string(100000, '[') + std::string(100000, ']')}) {
    CAPTURE(text.substr(0, 80));
    std::ofstream(bad) << text;
    check_refused("bench sizes --n 0 --beside " + bad, "bad.json");
  }
  REQUIRE(mkfifo(scratch.file("pipe").c_str(), 0600) == 0);
  check_refused("bench sizes --n 0 --beside " + scratch.file("pipe"), "pipe");
  std::ofstream(bad) << R"({"name": "a\u001b[31m", "sizes": [{"bodies": 8, "ms": {"median": 1}}]})";
  const std::string escaped = command("bench sizes --n 0 --beside " + bad).out;
  CHECK(escaped.find("a\\x1b[31m, ms") != std::string::npos);
  CHECK(escaped.find("0.00") == std::string::npos); /* no penetration is said */
}

TEST_CASE("command: bench broadphase of some, and what it refuses", "[command]")
{
  const Json two = json_of("bench broadphase --n 20000 --scene static --broadphase bvh,brute-force");
  REQUIRE(two["scenes"].size() == 1);
  REQUIRE(two["scenes"][0]["runs"].size() == 2);
  CHECK(two["scenes"][0]["runs"][0]["broadphase"] == "brute-force");
  CHECK(two["scenes"][0]["runs"][0]["skipped"] == "over 16384: skipped");
  CHECK(two["scenes"][0]["runs"][0]["ms"].is_null());
  CHECK(two["scenes"][0]["runs"][1]["skipped"].is_null());
  CHECK(two["scenes"][0]["runs"][1]["pairs"].get<int>() > 0);
  check_refused("bench broadphase --broadphase magic", "magic");
  check_refused("bench broadphase --scene castle", "castle");
  for (const char *n : {"1", "64000001", "many"}) check_refused(std::string("bench broadphase --n ") + n, "--n");
  check_refused("bench broadphase --on abacus --n 100", "abacus");
  check_refused("bench broadphase --chart /nonexistent/c.svg", "/nonexistent/c.svg");
  check_refused("bench broadphase --pairs box-box", "--pairs");
  check_refused("bench sort --broadphase grid", "--broadphase");
  check_refused("bench narrowphase --scene pile", "--scene");
  check_refused("bench step --chart c.svg", "--chart");
}

TEST_CASE("command: bench narrowphase", "[command]")
{
  const Json bench = json_of("bench narrowphase --n 90 --on serial");
  check_keys(bench, {"what", "backend", "n", "pairs"});
  std::set<std::string> kinds;
  for (const Json &row : bench["pairs"]) {
    INFO(row.dump());
    check_keys(row, {"pair", "kernel", "method", "n", "manifolds", "points", "ms", "manifolds_per_second"});
    kinds.insert(row["pair"].get<std::string>());
    CHECK(row["n"] == 90);
    CHECK(row["manifolds"] == 90);
    CHECK(row["points"] >= 90);
    CHECK(row["ms"]["median"].get<double>() > 0);
  }
  CHECK(kinds.size() == 11);
  const Json two = json_of("bench narrowphase --n 30 --on serial --pairs box-box,sphere-sphere");
  REQUIRE(two["pairs"].size() == 2);
  CHECK(two["pairs"][0]["pair"] == "sphere-sphere");
  CHECK(two["pairs"][1]["pair"] == "box-box");
  check_refused("bench narrowphase --pairs box-ball", "box-ball");
  check_refused("bench sort --pairs box-box", "--pairs");
  check_refused("bench narrowphase --n 0", "--n");
}

TEST_CASE("command: bench", "[command]")
{
  for (const char *what : {"sort --n 1000", "scan --n 1000", "step --n 8"}) {
    const Json bench = json_of(std::string("bench ") + what + " --on serial");
    check_keys(bench, {"what", "backend", "n", "ms", "items_per_second"});
    CHECK(bench["ms"]["median"].get<double>() > 0);
  }
}
#endif
