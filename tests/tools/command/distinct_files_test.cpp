/* distinct_files_test.cpp - outputs that would overwrite each other or an input, outputs that a limit cuts off, and the
 * files that a terminated run leaves. */
#ifdef TANDEM_COMMAND
#include <csignal>
#include <set>

#include "tests/tools/command/command_line.h"

using namespace command_line;

namespace {

const std::string scenes = TANDEM_SOURCE_DIR "/tests/scenes/";
const std::string long_run = "run spheres:n=3 --steps 1000000000";

std::set<std::string> names_in(const files::path &folder)
{
  std::set<std::string> names;
  for (const auto &entry : files::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

void copy(const std::string &name, const Scratch &folder) { files::copy_file(scenes + name, folder.file(name)); }

/* In the folder, so that relative names meet absolute ones. */
Result in_folder(const Scratch &folder, const std::string &arguments)
{
  return shell("cd '" + folder.path.string() + "' && '" + program() + "' " + arguments);
}

void check_clash(const Scratch &folder, const std::string &arguments, const std::string &mentions)
{
  const Result result = in_folder(folder, arguments);
  CAPTURE(arguments, result.error, result.out);
  CHECK(result.status == 2);
  CHECK(std::count(result.error.begin(), result.error.end(), '\n') == 1);
  CHECK(result.error.find(mentions) != std::string::npos);
}

/* Starts a run that writes, waits until it does, and ends it by a signal, which shells let ignore what runs behind
 * them. The status is that of the shell: 128 and the signal. */
Result ended_by(const std::string &signal, const Scratch &folder)
{
  return shell("cd '" + folder.path.string() + "' && { env --default-signal='" + signal + "' '" + program() +
               "' run spheres:n=3 --steps 100000000 --on serial --events e.json --save s.glb >/dev/null & } && "
               "until ls *.unfinished-* >/dev/null 2>&1; do sleep 0.05; done; kill -" +
               signal + " $!; wait $!; exit $?");
}

} // namespace

TEST_CASE("distinct files: two outputs of one name are refused before anything runs", "[command]")
{
  const Scratch folder;
  check_clash(folder, long_run + " --json same.out --events same.out", "--events writes this file too");
  check_clash(folder, long_run + " --trace same.png --image ./same.png", "same.png");
  check_clash(folder, long_run + " --trace t.json --events '" + folder.file("t.json") + "'", "t.json");
  files::create_symlink("target.json", folder.file("link.json"));
  check_clash(folder, long_run + " --trace link.json --json target.json", "--trace writes this file too");
  check_clash(folder, "bench broadphase --n 10 --chart c --json c", "--json writes this file too");
  check_clash(folder, "stability --only flight --solvers soft-step --out o --json o/figures.csv",
              "--out writes this file too");
  check_clash(folder,
              "report --quick --parts problems --problems '" + scenes +
                  "contact-sliding.dat' --out p --json p/report.csv",
              "--out writes this file too");
  CHECK(names_in(folder.path) == std::set<std::string>{"link.json", "o", "p"});
}

TEST_CASE("distinct files: an output in the place of an input is refused, whatever its name, and the input stays",
          "[command]")
{
  const Scratch folder;
  copy("three_bodies.json", folder);
  copy("contact-sliding.dat", folder);
  const std::string scene = contents(folder.file("three_bodies.json")),
                    problem = contents(folder.file("contact-sliding.dat"));
  files::create_hard_link(folder.file("three_bodies.json"), folder.file("again.json"));
  files::create_symlink("three_bodies.json", folder.file("link.json"));
  for (const std::string name : {"three_bodies.json", "again.json", "link.json"}) {
    for (const std::string option : {"--json ", "--events ", "--save "})
      check_clash(folder, "run three_bodies.json --steps 1000000000 " + option + name, "SCENE reads this file");
    check_clash(folder, "diff three_bodies.json --steps 1000000000 --json " + name, "SCENE reads this file");
    check_clash(folder, "plan three_bodies.json --json " + name, "SCENE reads this file");
  }
  check_clash(folder, "contact-problem contact-sliding.dat --json contact-sliding.dat", "FILE reads this file");
  check_clash(folder,
              "report --quick --parts problems --problems contact-sliding.dat --out . --json contact-sliding.dat",
              "--problems reads this file");
  CHECK(contents(folder.file("three_bodies.json")) == scene);
  CHECK(contents(folder.file("contact-sliding.dat")) == problem);
}

TEST_CASE("distinct files: what a scene names is an input too", "[command]")
{
  const Scratch folder;
  std::ofstream(folder.file("tetrahedron.obj"))
      << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  std::ofstream(folder.file("scene.json"))
      << R"({"tandem_scene": 1, "shapes": [{"type": "mesh", "obj": "tetrahedron.obj"}], "bodies": [{"shape": 0,)"
         R"( "motion": "fixed"}]})";
  const Result read = in_folder(folder, "plan scene.json");
  CAPTURE(read.error);
  REQUIRE(read.status == 0);
  check_clash(folder, "run scene.json --steps 1000000000 --json tetrahedron.obj", "SCENE reads this file");
}

TEST_CASE("distinct files: devices take any number of outputs, and distinct ones are written", "[command]")
{
  const Scratch folder;
  CHECK(in_folder(folder, "run spheres:n=3 --steps 2 --json /dev/null --events /dev/null --trace /dev/null").status ==
        0);
  CHECK(in_folder(folder, "run spheres:n=3 --steps 2 --json a --events b --trace c").status == 0);
  CHECK(names_in(folder.path) == std::set<std::string>{"a", "b", "c"});
}

TEST_CASE("unfinished files: a limit of their size is told as a full disk is, and nothing stays", "[command]")
{
  const Scratch folder;
  const Result result = in_folder(folder, "--version >/dev/null; ulimit -f 1; '" + program() +
                                              "' run spheres:n=300 --steps 30 --save big.glb --events big.json");
  CAPTURE(result.error);
  CHECK(result.status == 2);
  CHECK(result.error.find("File too large") != std::string::npos);
  CHECK(std::count(result.error.begin(), result.error.end(), '\n') == 1);
  CHECK(names_in(folder.path).empty());
}

TEST_CASE("unfinished files: a run that is told to end leaves none, and dies of that signal", "[command]")
{
  for (const auto &[signal, status] :
       {std::pair{"INT", 128 + SIGINT}, {"TERM", 128 + SIGTERM}, {"HUP", 128 + SIGHUP}}) {
    const Scratch folder;
    const Result result = ended_by(signal, folder);
    CAPTURE(signal, result.error);
    CHECK(result.status == status);
    CHECK(names_in(folder.path).empty());
  }
}
#endif
