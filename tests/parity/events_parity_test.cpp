/* Events and triggers give the serial backend's bits on every backend, and the same list. */
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

std::string triggers() { return TANDEM_SOURCE_DIR "/tests/scenes/triggers.json"; }

Settings with_events()
{
  Settings settings;
  settings.events = true;
  return settings;
}

/* One build of all features serves all tests on OpenCL. */
Settings with_all()
{
  Settings settings = with_events();
  settings.specialise = false;
  return settings;
}

void require_same_events(const std::string &backend)
{
  World one(load_scene(triggers()), with_all(), Placement{"serial", {}, false}),
      other(load_scene(triggers()), with_all(), Placement{backend, {}, false});
  size_t compared = 0;
  for (int step = 0; step < 60; ++step) {
    one.step();
    other.step();
    const std::vector<ContactEvent> expected = one.contact_events(), found = other.contact_events();
    CAPTURE(backend, step);
    REQUIRE(found.size() == expected.size());
    for (size_t i = 0; i < found.size(); ++i) {
      const ContactEvent &x = found[i], &y = expected[i];
      REQUIRE(std::tie(x.kind, x.a, x.b, x.trigger, x.points, x.impulse, x.separation, x.point, x.normal) ==
              std::tie(y.kind, y.a, y.b, y.trigger, y.points, y.impulse, y.separation, y.point, y.normal));
    }
    compared += found.size();
  }
  CHECK(compared > 100);
}

} // namespace

TEST_CASE("parity on CPU: events") { require_parity("mixed:n=60", cpu_backends(), 40, with_events()); }
TEST_CASE("parity on CPU: events of more pairs than a tile has items")
{
  require_parity("box-grid:nx=7,ny=6,nz=7", cpu_backends(), 5, with_events());
}
TEST_CASE("parity on CPU: triggers", "[sanitizer]")
{
  require_parity(triggers(), {"serial", "serial:order=backward", "tbb:threads=4"}, 40, with_events());
}

TEST_CASE("parity on CPU: events with every solver")
{
  for (const Solver solver : choices<Solver>()) {
    Settings settings = settings_for(solver);
    settings.events = true;
    require_parity("mixed:n=40", {"serial", "serial:order=shuffled", "tbb:threads=7"}, 30, settings);
  }
}

TEST_CASE("parity on CPU: the list of events is one on every backend")
{
  require_same_events("tbb:threads=7");
  require_same_events("serial:order=backward");
}

TEST_CASE("parity on OpenCL: events and triggers")
{
  require_pocl();
  require_parity(triggers(), {"serial", "cl:pocl"}, 60, with_all());
  require_same_events("cl:pocl");
}
