/* hostile_files_test.cpp - files that could crash, hang, escape or vanish: each gives one line and status 2, and no
 * existing file is lost. */
#ifdef TANDEM_COMMAND
#include <csignal>
#include <set>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>

#include "tests/tools/command/command_line.h"

using namespace command_line;

namespace {

const std::string one_box = "box-grid:nx=1,ny=1,nz=1";

std::string repeated(const std::string &text, int times)
{
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

void write(const std::string &path, const std::string &text) { std::ofstream(path, std::ios::binary) << text; }

std::string mesh_scene(const std::string &obj)
{
  return R"({"tandem_scene":1,"shapes":[{"type":"mesh","obj":")" + obj +
         R"("}],"bodies":[{"shape":0,"motion":"fixed"}]})";
}

/* A scene with a collider that needs a buffer of three vertices. */
std::string gltf_scene(const std::string &uri)
{
  return R"({"asset":{"version":"2.0"},"nodes":[{"name":"Cup",)"
         R"("extensions":{"KHR_physics_rigid_bodies":{"collider":{"geometry":{"mesh":0}}}}}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,)"
         R"("componentType":5126,"type":"VEC3","count":3}],)"
         R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":")" +
         uri + R"("}]})";
}

/* A link whose shape is a mesh. */
std::string urdf_scene(const std::string &mesh)
{
  return "<robot><link name=\"base\"><collision><geometry><mesh filename=\"" + mesh +
         "\"/></geometry></collision></link></robot>";
}

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 0 -1\nf 1 2 3\n";
const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 0, -1};

std::string run(const std::string &scene) { return "run '" + scene + "' --steps 1 --on serial"; }

/* The names of the files in a folder. */
std::set<std::string> names_in(const files::path &folder)
{
  std::set<std::string> names;
  for (const auto &entry : files::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

} // namespace

TEST_CASE("hostile files: nesting is refused by its depth", "[command]")
{
  const Scratch scratch;
  const std::string asset = R"({"asset":{"version":"2.0"},"extras":)",
                    compound = R"({"type":"compound","children":[{"shape":)";
  const std::string nested = repeated("[", 15000) + repeated("]", 15000);
  write(scratch.file("open.json"), repeated("[", 90000));
  write(scratch.file("closed.json"),
        R"({"tandem_scene":1,"shapes":)" + repeated("[", 90000) + repeated("]", 90000) + "}");
  write(scratch.file("objects.json"), repeated(R"({"a":)", 90000) + "1" + repeated("}", 90000));
  write(scratch.file("compounds.json"), R"({"tandem_scene":1,"bodies":[],"shapes":[)" + repeated(compound, 20000) +
                                            R"({"type":"sphere","radius":1})" + repeated("}]}", 20000) + "]}");
  write(scratch.file("extras.gltf"), asset + nested + "}");
  const std::string json = asset + nested + "} ", length(4, '\0');
  std::string binary = "glTF" + std::string("\2\0\0\0", 4) + length + length + "JSON" + json;
  for (const auto &[at, size] : {std::pair<size_t, size_t>{8, binary.size()}, {12, json.size()}})
    for (size_t byte = 0; byte < 4; ++byte) binary[at + byte] = static_cast<char>(size >> 8 * byte);
  write(scratch.file("extras.glb"), binary);
  for (const char *name : {"open.json", "closed.json", "objects.json", "compounds.json", "extras.gltf", "extras.glb"})
    check_refused(run(scratch.file(name)), "more than 100 deep");
  write(scratch.file("links.urdf"), "<robot>" + repeated("<link>", 15000));
  write(scratch.file("bodies.xml"),
        "<mujoco><worldbody>" + repeated("<body>", 15000) + repeated("</body>", 15000) + "</worldbody></mujoco>");
  for (const char *name : {"links.urdf", "bodies.xml"})
    check_refused(run(scratch.file(name)), "more than some hundred deep");
}

TEST_CASE("hostile files: a compound in a compound is refused, however few", "[command]")
{
  const Scratch scratch;
  const std::string compound = R"({"type":"compound","children":[{"shape":)";
  write(scratch.file("two.json"), R"({"tandem_scene":1,"bodies":[],"shapes":[)" + repeated(compound, 2) +
                                      R"({"type":"sphere","radius":1})" + repeated("}]}", 2) + "]}");
  check_refused(run(scratch.file("two.json")), "cannot be a child");
}

TEST_CASE("hostile files: a tree of nodes may be deep, but must be a tree", "[command]")
{
  const Scratch scratch;
  const std::string head =
      R"({"asset":{"version":"2.0"},"extensions":{"KHR_implicit_shapes":{"shapes":[{"type":"box","box":{}}]}},)"
      R"("nodes":[)";
  const std::string physics =
      R"("extensions":{"KHR_physics_rigid_bodies":{"motion":{},"collider":{"geometry":{"shape":0}}}}})";
  std::string deep = head;
  for (int i = 0; i < 20000; ++i) deep += R"({"children":[)" + std::to_string(i + 1) + "]},";
  write(scratch.file("deep.gltf"), deep + "{" + physics + "]}");
  const Json json = json_of(run(scratch.file("deep.gltf")));
  CHECK(json["bodies"] == 1);
  write(scratch.file("ring.gltf"),
        head + R"({"children":[1]},{"children":[0],)" + physics + R"(],"scenes":[{"nodes":[0]}]})");
  check_refused(run(scratch.file("ring.gltf")), "has two parents");
}

TEST_CASE("hostile files: pipes and devices are no scenes, buffers or problems", "[command]")
{
  const Scratch scratch;
  const auto refused = [&](const std::string &arguments) { check_refused(arguments, "a regular file is needed"); };
  for (const char *name : {"pipe.json", "pipe.gltf", "pipe.urdf", "pipe.xml", "pipe.dat", "pipe.obj", "pipe.bin"})
    REQUIRE(mkfifo(scratch.file(name).c_str(), 0600) == 0);
  for (const char *name : {"zero.json", "zero.glb", "zero.dat"}) files::create_symlink("/dev/zero", scratch.file(name));
  for (const char *name : {"pipe.json", "pipe.gltf", "pipe.urdf", "pipe.xml", "zero.json", "zero.glb"})
    refused(run(scratch.file(name)));
  for (const char *name : {"pipe.dat", "zero.dat"}) refused("contact-problem " + scratch.file(name));
  write(scratch.file("mesh.json"), mesh_scene("pipe.obj"));
  refused(run(scratch.file("mesh.json")));
  write(scratch.file("mesh.gltf"), gltf_scene("pipe.bin"));
  refused(run(scratch.file("mesh.gltf")));
  write(scratch.file("mesh.urdf"), urdf_scene("pipe.obj"));
  refused(run(scratch.file("mesh.urdf")));
  for (const std::string &page : {scratch.file("pipe.dat"), std::string("/dev/zero")})
    refused("stability --quick --only flip --solvers soft-step --out " + scratch.file("results") + " --table-in " +
            page);
  check_refused(run(scratch.path.string() + "/.json"), "No such file");
}

TEST_CASE("hostile options: an empty value is no value", "[command]")
{
  const Scratch scratch;
  for (const char *option :
       {"json", "save", "image", "events", "trace", "place", "substeps", "iterations", "steps", "solver"})
    check_refused("run " + one_box + " --" + option + " ''", std::string("--") + option);
  check_refused("diff " + one_box + " --between serial,tbb --steps 2 --plant ''", "--plant '': a value is needed");
  check_refused("stability --quick --only flip --out " + scratch.file("results") + " --table-in ''", "--table-in");
}

TEST_CASE("hostile files: no output goes where the command prints", "[command]")
{
  const Scratch scratch;
  const std::string printed = scratch.file("printed"), into = " > " + printed;
  for (const char *option : {"events", "trace", "save", "image"}) {
    for (const std::string &place : {printed, std::string("/dev/stdout")})
      for (const char *json : {"", " --json -"})
        check_refused("run " + one_box + " --steps 1 --on serial --" + option + " " + place + json + into,
                      "this is standard output");
    CHECK(contents(printed).empty());
    check_refused("run " + one_box + " --steps 1 --on serial --" + option + " -", "a file is needed");
  }
  CHECK(command("run " + one_box + " --steps 1 --on serial --events /dev/null > /dev/null").status == 0);
}

TEST_CASE("hostile files: what a scene names lies below its folder", "[command]")
{
  const Scratch scratch;
  files::create_directories(scratch.path / "scene" / "below");
  const std::string bytes(reinterpret_cast<const char *>(corners), sizeof corners),
      outside = "lies outside the folder of the scene";
  for (const char *folder : {"", "scene/", "scene/below/"}) {
    write(scratch.file(std::string(folder) + "a b.obj"), triangle);
    write(scratch.file(std::string(folder) + "a b.bin"), bytes);
  }
  files::create_symlink(scratch.path, scratch.path / "scene" / "link");
  files::create_symlink("below", scratch.path / "scene" / "inner");
  const auto json = [&](const std::string &name) {
    write(scratch.file("scene/s.json"), mesh_scene(name));
    return run(scratch.file("scene/s.json"));
  };
  const auto gltf = [&](const std::string &uri) {
    write(scratch.file("scene/s.gltf"), gltf_scene(uri));
    return run(scratch.file("scene/s.gltf"));
  };
  const std::string up = scratch.file("a b");
  for (const std::string &name :
       std::vector<std::string>{"../a b.obj", "below/../../a b.obj", "link/a b.obj", up + ".obj"}) {
    check_refused(json(name), outside);
    CHECK(command(json(name) + " --allow-outside-files").status == 0);
  }
  for (const std::string &uri : std::vector<std::string>{"../a b.bin", "../a%20b.bin", "%2e%2e/a%20b.bin",
                                                         "%2E%2E%2Fa b.bin", "link/a%20b.bin", up + ".bin"}) {
    check_refused(gltf(uri), outside);
    CHECK(command(gltf(uri) + " --allow-outside-files").status == 0);
  }
  for (const char *name : {"a b.obj", "below/a b.obj", "inner/a b.obj", "below/../a b.obj"})
    CHECK(command(json(name)).status == 0);
  for (const char *uri : {"a%20b.bin", "a b.bin", "below/a%20b.bin", "inner/a%20b.bin"})
    CHECK(command(gltf(uri)).status == 0);
  check_refused(gltf("a%00b.bin"), "is no name of a file");
  check_refused(gltf("file:///etc/passwd"), "cannot read");
  check_refused(gltf("missing.bin"), "buffers[0].uri");
}

TEST_CASE(
    "hostile files: a file that a scene names and that is missing is called missing, from wherever the command runs",
    "[command]")
{
  const Scratch scratch;
  files::create_directories(scratch.path / "below");
  for (const char *name : {"missing.obj", "below/missing.obj", "nowhere/missing.obj"}) {
    write(scratch.file("s.json"), mesh_scene(name));
    for (const std::string &scene :
         std::vector<std::string>{"s.json", "./s.json", "below/../s.json", scratch.file("s.json")})
      check_refused(run(scene), "No such file", "cd " + scratch.path.string() + ";");
  }
  for (const char *name : {"../missing.obj", "below/../../missing.obj"}) {
    write(scratch.file("s.json"), mesh_scene(name));
    check_refused(run("s.json"), "lies outside the folder of the scene", "cd " + scratch.path.string() + ";");
  }
}

TEST_CASE("hostile files: a zero byte ends no file", "[command]")
{
  const Scratch scratch;
  const std::string zero(1, '\0'),
      json = R"({"tandem_scene":1,"shapes":[{"type":"sphere","radius":1}],"bodies":[{"shape":0}]})";
  for (const std::string &text : {json + zero, json + zero + "garbage", json + "\n" + zero + "\n", zero + json,
                                  json.substr(0, 20) + zero + json.substr(20)}) {
    write(scratch.file("zero.json"), text);
    check_refused(run(scratch.file("zero.json")), "a byte of 0");
    write(scratch.file("zero.gltf"), text);
    check_refused(run(scratch.file("zero.gltf")), "a byte of 0");
  }
  write(scratch.file("mesh.json"), mesh_scene("zero.obj"));
  for (const std::string &text : {zero + triangle, "v 0 0 0\n# a " + zero + " remark\n" + triangle, triangle + zero}) {
    write(scratch.file("zero.obj"), text);
    check_refused(run(scratch.file("mesh.json")), "holds a byte of 0");
  }
}

TEST_CASE("hostile files: what a mesh leaves out is said, and a name is one printable line", "[command]")
{
  const Scratch scratch;
  const std::string sliver =
      R"({"tandem_scene":1,"shapes":[{"type":"mesh","vertices":[[0,0,0],[0,0,1],[1,0,0],[0.5,1e-9,0]],)"
      R"("triangles":[[0,1,2],[0,3,2],[1,2,0]]}],)";
  write(scratch.file("sliver.json"), sliver + R"("bodies":[{"shape":0,"motion":"fixed"}]})");
  const Result result = command(run(scratch.file("sliver.json")));
  CHECK(result.status == 0);
  CHECK(result.error.find("shape 0: mesh: ") != std::string::npos);
  CHECK(result.error.find("1 repeated triangles and 1 without area left out\n") != std::string::npos);
  write(scratch.file("name.json"),
        sliver + R"("bodies":[{"shape":0,"motion":"fixed","name":"a\nb\u0000\u001bc","mass":1e39}]})");
  check_refused(run(scratch.file("name.json")), "mass");
  write(scratch.file("name.json"),
        sliver + R"("bodies":[{"shape":0,"motion":"fixed","name":"a\nb\u0000\u001bc","linear_damping":-1}]})");
  check_refused(run(scratch.file("name.json")), "body 0 'a\\nb\\x00\\x1bc': linear_damping");
}

TEST_CASE("hostile numbers: what is not 0 but rounds to it is refused where 0 stands for something else", "[command]")
{
  const Scratch scratch;
  const auto body = [&](const std::string &members, const std::string &scale = "[1,1,1]") {
    write(
        scratch.file("small.json"),
        R"({"tandem_scene":1,"shapes":[{"type":"mesh","vertices":[[0,0,0],[3,0,0],[0,2,0],[0,0,1]],"triangles":[[0,2,)"
        R"(1],[0,1,3],[0,3,2],[1,2,3]],"scale":)" +
            scale + R"(}],"bodies":[{"shape":0,"motion":"fixed",)" + members + "}]}");
    return run(scratch.file("small.json"));
  };
  for (const char *small : {"1e-46", "-1e-300", "1e-999"}) {
    check_refused(body("\"mass\":" + std::string(small)), "bodies[0].mass: is ");
    check_refused(body("\"inertia\":[1,1," + std::string(small) + "]"), "bodies[0].inertia[2]: is ");
    check_refused(body("\"linear_damping\":" + std::string(small)), "bodies[0].linear_damping: is ");
    check_refused(body("\"mass\":1", "[1,1," + std::string(small) + "]"), "shapes[0].scale[2]: is ");
    CHECK(command(body("\"linear_velocity\":[0,0," + std::string(small) + "]")).status == 0);
  }
}

TEST_CASE("hostile numbers: a ball rests on a strip of 20 km by 1 cm", "[command]")
{
  const Scratch scratch;
  write(scratch.file("strip.json"),
        R"({"tandem_scene":1,"shapes":[{"type":"mesh","vertices":[[-10000,0,-0.005],[-10000,0,0.005],[10000,0,0.005],)"
        R"([10000,0,-0.005]],)"
        R"("triangles":[[0,1,2],[0,2,3]]},{"type":"sphere","radius":0.5}],"bodies":[{"motion":"fixed","shape":0},)"
        R"({"shape":1,"position":[100,0.5,0]}]})");
  const Json json = json_of("run " + scratch.file("strip.json") + " --steps 10 --on serial");
  CHECK(json["contacts"].get<int>() > 0);
}

TEST_CASE("hostile files: an output that cannot be written is one line and status 2, and no file is lost", "[command]")
{
  const Scratch scratch;
  const std::pair<const char *, std::string> outputs[] = {
      {"full.json", "run " + one_box + " --steps 2 --json "},
      {"full.png", "run " + one_box + " --steps 2 --image-size 8x8 --image "},
      {"full.glb", "run " + one_box + " --steps 2 --save "},
      {"full.trace", "run " + one_box + " --steps 2 --trace "},
      {"full.events", "run " + one_box + " --steps 2 --events "},
      {"full.svg", "bench broadphase --n 8 --broadphase grid --on serial --chart "},
      {"scenes.json", "scenes --json "},
      {"diff.json", "diff " + one_box + " --steps 1 --json "}};
  for (const auto &[name, arguments] : outputs) {
    files::create_symlink("/dev/full", scratch.file(name));
    const Result result = command(arguments + scratch.file(name));
    INFO(arguments << result.error);
    CHECK(result.status == 2);
    CHECK(std::count(result.error.begin(), result.error.end(), '\n') == 1);
    CHECK(result.error.find("No space left on device") != std::string::npos);
    CHECK(files::is_symlink(scratch.file(name)));
  }
  CHECK(files::exists("/dev/full"));
  CHECK(names_in(scratch.path).size() == std::size(outputs));
}

TEST_CASE("hostile files: each file of a folder of results is checked", "[command]")
{
  const std::string problem =
      "report --quick --parts problems --problems '" TANDEM_SOURCE_DIR "/tests/scenes/contact-sliding.dat' --out ";
  const std::string flight = "stability --only flight --solvers soft-step --on serial --out ";
  for (const auto &[arguments, name] : {std::pair{problem, "report.html"},
                                        {problem, "report.csv"},
                                        {problem, "report.json"},
                                        {flight, "index.html"},
                                        {flight, "figures.csv"},
                                        {flight, "stability.json"}}) {
    const Scratch scratch;
    files::create_symlink("/dev/full", scratch.file(name));
    const Result result = command(arguments + scratch.path.string());
    INFO(name << "\n" << result.error);
    CHECK(result.status == 2);
    CHECK(result.error == "tandem: --out " + scratch.file(name) + ": cannot write: No space left on device\n");
    CHECK(files::is_symlink(scratch.file(name)));
  }
}

TEST_CASE("hostile files: what was printed is written, or the status says so", "[command]")
{
  for (const std::string &arguments :
       std::vector<std::string>{"scenes", "--help", "--version", "devices", "run " + one_box + " --steps 1",
                                "run " + one_box + " --steps 1 --json -", "plan " + one_box, "stability --list"}) {
    for (const auto &[output, why] :
         {std::pair(" >/dev/full", "No space left on device"), std::pair(" >&-", "Bad file descriptor")}) {
      const Result result = command(arguments + output, "OCL_ICD_VENDORS=/nonexistent/");
      INFO(arguments << output);
      CHECK(result.status == 2);
      CHECK(result.error == std::string("tandem: standard output: cannot write: ") + why + "\n");
    }
  }
  CHECK(command("run " + one_box + " --steps 1 --json /dev/stdout >/dev/full").error ==
        "tandem: --json /dev/stdout: cannot write: No space left on device\n");
}

TEST_CASE("hostile files: a file is replaced whole, with its mode, through links, and a run that fails leaves it",
          "[command]")
{
  const Scratch scratch;
  for (const char *name : {"kept.json", "real.json", "kept.glb.frames"}) write(scratch.file(name), "kept");
  REQUIRE(chmod(scratch.file("real.json").c_str(), 0640) == 0);
  files::create_symlink("real.json", scratch.file("link.json"));
  check_refused("run castle --json " + scratch.file("kept.json"), "castle");
  CHECK(command("run " + one_box + " --steps 1 --trace " + scratch.file("kept.json") + " --json /dev/full").status ==
        2);
  CHECK(command("run " + one_box + " --steps 1 --save " + scratch.file("kept.glb") + " --json " +
                scratch.file("link.json"))
            .status == 0);
  CHECK(contents(scratch.file("kept.glb.frames")) == "kept");
  CHECK(files::is_symlink(scratch.file("link.json")));
  CHECK(Json::parse(contents(scratch.file("real.json")))["steps"] == 1);
  struct stat status {};
  REQUIRE(stat(scratch.file("real.json").c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0640);
  CHECK(names_in(scratch.path) ==
        std::set<std::string>{"kept.glb", "kept.glb.frames", "kept.json", "link.json", "real.json"});
}

TEST_CASE("hostile files: a pipe takes what is written to it", "[command]")
{
  const Scratch scratch;
  const std::string pipe = scratch.file("pipe.glb");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  check_refused("run " + one_box + " --steps 2 --save " + pipe, "cannot write"); /* nobody reads */
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  CHECK(command("run " + one_box + " --steps 2 --save " + pipe).status == 0);
  std::string copy(1 << 16, '\0'); /* as much as a pipe holds while nobody reads */
  const ssize_t size = read(reader, copy.data(), copy.size());
  close(reader);
  REQUIRE(size > 0);
  copy.resize(static_cast<size_t>(size));
  CHECK(command("run " + one_box + " --steps 2 --save " + scratch.file("plain.glb")).status == 0);
  CHECK(copy == contents(scratch.file("plain.glb")));
  CHECK(files::is_fifo(pipe));
}

TEST_CASE("hostile files: a pipe whose reader goes is an output that cannot be written", "[command]")
{
  const Scratch scratch;
  const std::string pipe = scratch.file("pipe.glb");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  std::thread leaves([&] { /* at the first byte, long before the last */
                           pollfd waiting{reader, POLLIN, 0};
                           poll(&waiting, 1, -1);
                           close(reader);
  });
  const Result result = command("run box-grid:nx=6,ny=6,nz=6 --steps 60 --save " + pipe);
  leaves.join();
  CHECK(result.status == 2);
  CHECK(result.error == "tandem: " + pipe + ": cannot write: Broken pipe\n");
}

TEST_CASE("hostile files: a reader of standard output may go without a word", "[command]")
{
  const Scratch scratch;
  const std::string pipe = "'" + scratch.file("pipe") + "'";
  REQUIRE(mkfifo(scratch.file("pipe").c_str(), 0600) == 0);
  const Result result =
      command("stability --list >&9", "exec 8<>" + pipe + " 9>" + pipe + " 8<&-;"); /* a writer, and nobody who reads */
  CHECK(result.error.empty());
  CHECK(result.status == 128 + SIGPIPE);
}

TEST_CASE("hostile numbers: a run whose bodies do not stay finite says so in its status", "[command]")
{
  const Scratch scratch;
  write(
      scratch.file("fast.json"),
      R"({"tandem_scene":1,"shapes":[{"type":"sphere","radius":0.5}],"bodies":[{"name":"fly","linear_velocity":[3e38,)"
      R"(0,0]},{"position":[5,0,0]}]})");
  const std::string arguments = "run " + scratch.file("fast.json") + " --dt 10 --steps 60 --on serial --json -";
  const Result refused = command(arguments), allowed = command(arguments + " --allow-quarantine");
  INFO(refused.error << allowed.error);
  CHECK(refused.status == 1);
  CHECK(refused.error.find("tandem: body 0 'fly' stopped being finite") == 0);
  CHECK(refused.error.find("tandem: 1 of 2 bodies did not stay finite") != std::string::npos);
  CHECK(allowed.status == 0);
  CHECK(allowed.error.find("did not stay finite") == std::string::npos);
  CHECK(Json::parse(refused.out)["nonfinite"] == 1);
  CHECK(Json::parse(allowed.out)["nonfinite"] == 1);
}

TEST_CASE("hostile numbers: contact problems outside the range of floats", "[command]")
{
  const Scratch scratch;
  const auto problem = [&](const std::string &first, const std::string &q, const std::string &mu) {
    write(scratch.file("p.dat"), "3\n1\n0\n3\n3\n3 3\n" + first + " 0 0\n0 1 0\n0 0 1\n" + q + " 0 0\n" + mu + "\n");
    return "contact-problem " + scratch.file("p.dat");
  };
  CHECK(command(problem("1", "-1", "0.5")).status == 0);
  for (const char *large : {"1e300", "-1e39", "3.5e38", "1e999"}) {
    check_refused(problem(large, "-1", "0.5"), "line 7");
    check_refused(problem("1", large, "0.5"), "line 10");
    check_refused(problem("1", "-1", large), "line 11");
  }
  const std::string sliding = contents(TANDEM_SOURCE_DIR "/tests/scenes/contact-sliding.dat"), entry = "2.0 0.0 0.0";
  REQUIRE(sliding.find(entry) != std::string::npos);
  for (const char *solver : {"pgs", "nncg", "jacobi"})
    for (const char *large : {"18446744073709551616", "1e30", "3e38"}) {
      CHECK(command(problem("1", "-" + std::string(large), "0.5") + " --solver " + solver).status == 0);
      for (const std::string &row : {"2.0 " + std::string(large) + " 0.0", "2.0 0.0 " + std::string(large)}) {
        write(scratch.file("sliding.dat"), std::string(sliding).replace(sliding.find(entry), entry.size(), row));
        check_refused("contact-problem " + scratch.file("sliding.dat") + " --solver " + solver,
                      "the range of 32-bit numbers does not suffice");
      }
    }
  for (const char *small : {"1e-300", "1e-40", "0"})
    check_refused(problem(small, "-1", "0.5"), "W[0][0] must be positive");
}

TEST_CASE("diff decides auto once for all backends, and says so", "[command]")
{
  const std::string scene = "diff box-grid:nx=5,ny=4,nz=5 --steps 2 --between ";
  const Json equal = json_of(scene + "serial,tbb");
  CHECK(equal["broadphase"] == "trees");
  CHECK(equal["broadphase_why"].get<std::string>().find("101 bodies on a CPU") == 0);
  const std::string told = "\nBroadphase on all of them: trees (101 bodies on a CPU";
  CHECK(command(scene + "serial,tbb").out.find(told) != std::string::npos);
  CHECK(json_of("diff " + one_box + " --steps 1")["broadphase"] == "brute-force");
  const Json devices = json_of("devices");
  for (const Json &device : devices["backends"])
    if (device["kind"] == "opencl" &&
        device["exact"] == true) { /* by itself it would take brute-force up to 128 bodies */
      const Json with_device = json_of(scene + "serial," + device["name"].get<std::string>());
      CHECK(with_device["equal"] == true);
      CHECK(with_device["broadphase"] == "trees");
      return;
    }
  tests::skip_device("no OpenCL device: the choice for one was not compared");
}
#endif
