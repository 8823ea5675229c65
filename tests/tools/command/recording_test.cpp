/* recording_test.cpp - the commands that write and read recordings: run --record, replay and diff. */
#ifdef TANDEM_COMMAND
#include "tests/tools/command/command_line.h"

using namespace command_line;

namespace {

const std::string few = "falling-boxes:n=20,height=0";

std::string recorded(const Scratch &scratch, const std::string &options = "")
{
  const std::string path = scratch.file("F.tandem");
  const Result result = command("run " + few + " --steps 12 --on serial --record " + path + " " + options);
  INFO(result.error);
  REQUIRE(result.status == 0);
  return path;
}

void change_byte(const std::string &path, size_t at)
{
  std::string text = contents(path);
  REQUIRE(at < text.size());
  text[at] = static_cast<char>(text[at] ^ 1);
  std::ofstream(path, std::ios::binary) << text;
}

} // namespace

TEST_CASE("command: a recorded run is replayed with the same hash", "[command]")
{
  const Scratch scratch;
  const std::string path = scratch.file("F.tandem");
  const Json run = json_of("run " + few + " --steps 12 --on serial --record " + path);
  const Json replay = json_of("replay " + path + " --on tbb --verify");
  CHECK(replay["hash"] == run["hash"]);
  CHECK(replay["equal"] == true);
  CHECK(replay["steps_compared"] == 12);
  CHECK(replay["finished"] == true);
  check_keys(replay,
             {"recording", "backend", "made_by", "bodies", "steps", "from", "steps_made", "ms", "first_difference"});
  CHECK(json_of("replay " + path)["steps_compared"] == 1); /* the last one */
  const Json part = json_of("replay " + path + " --verify --from 7");
  CHECK(part["steps_made"] == 12);
  CHECK(part["steps_compared"] == 5);
}

TEST_CASE("command: a replay starts at a snapshot within the recording", "[command]")
{
  const Scratch scratch;
  const std::string path = recorded(scratch, "--record-snapshots 5");
  const Json replay = json_of("replay " + path + " --verify --from 11");
  CHECK(replay["from"] == 10);
  CHECK(replay["steps_made"] == 2);
  CHECK(replay["equal"] == true);
}

TEST_CASE("command: diff takes a recording as its scene", "[command]")
{
  const Scratch scratch;
  const std::string path = recorded(scratch);
  const Json all = json_of("diff " + path + " --between serial,tbb:threads=2");
  CHECK(all["equal"] == true);
  CHECK(all["steps"] == 12);
  CHECK(json_of("diff " + path + " --steps 3")["steps"] == 3);
  const Json planted = json_of("diff " + path + " --plant integrate_velocities:solver_velocity:5:2", 1);
  CHECK(planted["first_difference"]["step"] == 2);
  CHECK(planted["first_difference"]["gdb"].get<std::string>().find("tandem replay " + path) != std::string::npos);
  check_refused("diff " + path + " --solver pgs", "settings of its own; leave out --solver pgs");
}

TEST_CASE("command: bench snapshots has the promised keys", "[command]")
{
  const Json json = json_of("bench snapshots --n 27 --on serial");
  REQUIRE(json["worlds"].size() == 1);
  const Json &world = json["worlds"][0];
  check_keys(world, {"scene", "pairs", "keep_ms", "go_back_ms", "save_ms", "restore_ms", "save_gb_per_s"});
  CHECK(world["bodies"] == 28);
  CHECK(world["snapshot_bytes"].get<uint64_t>() > 28 * 80);
  check_refused("bench snapshots --n 0", "--n");
}

TEST_CASE("command: recordings that cannot be read or written are refused in one line", "[command]")
{
  const Scratch scratch;
  check_refused("run " + few + " --record F.txt", "ends in .tandem");
  check_refused("run " + few + " --record /nonexistent/F.tandem", "--record");
  check_refused("run " + few + " --record-snapshots 5", "--record");
  check_refused("replay " + scratch.file("none.tandem"), "none.tandem");
  const std::string path = recorded(scratch);
  check_refused("replay " + path + " --from 12", "from 0 to 11");
  check_refused("replay " + path + " --on gpu", "gpu");
  check_refused("replay " + path + " --json " + path, path);
  std::ofstream(scratch.file("other.tandem")) << "no recording at all, but long enough";
  check_refused("replay " + scratch.file("other.tandem"), "begins with 'TANDEMR'");
  std::filesystem::copy_file(path, scratch.file("cut.tandem"));
  std::filesystem::resize_file(scratch.file("cut.tandem"), 3000);
  check_refused("replay " + scratch.file("cut.tandem"), "bytes are needed");
  check_refused("diff " + scratch.file("cut.tandem"), "bytes are needed");
  change_byte(path, 5000);
  check_refused("replay " + path, "the file is damaged");
}

TEST_CASE("command: bench bodies and bench sleeping have the promised keys", "[command]")
{
  const Json bodies = json_of("bench bodies --n 30 --on serial");
  check_keys(bodies, {"what", "backend", "worlds"});
  REQUIRE(bodies["worlds"].size() == 1);
  CHECK(bodies["worlds"][0]["bodies"] == 30);
  CHECK(bodies["worlds"][0]["first_create_ms"].get<double>() > 0);
  for (const char *part : {"create_ms", "create_singly_ms", "step_after_create_ms", "destroy_ms", "read_ms"}) {
    const Json &time = bodies["worlds"][0][part];
    check_keys(time, {"median", "min", "max"});
    CHECK(time["min"].get<double>() > 0);
    CHECK(time["max"] >= time["median"]);
  }
  check_refused("bench bodies --n 0", "--n");
  check_refused("bench bodies --n 64000001", "--n");

  const Json sleeping = json_of("bench sleeping --n 45 --on serial");
  REQUIRE(sleeping["worlds"].size() == 1);
  CHECK(sleeping["worlds"][0]["bodies"] == 45);
  for (const char *part : {"awake_ms", "asleep_ms", "island_ms", "wake_ms", "fall_ms", "read_ms"})
    CHECK(sleeping["worlds"][0][part]["min"].get<double>() > 0);
  check_refused("bench sleeping --n 39", "--n");
}

#endif
