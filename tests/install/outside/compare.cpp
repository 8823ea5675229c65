/* An external project compares two backends on a built-in scene, and finds an error that it plants. */
#include <cstdio>

#include <tandem/compare.h>
#include <tandem/load_scene.h>
#include <tandem/version.h>

static_assert(TANDEM_VERSION >= TANDEM_VERSION_NUMBER(0, 1, 0) && TANDEM_VERSION < TANDEM_VERSION_NUMBER(1, 0, 0));

int main()
{
  const tandem::Scene scene = tandem::load_scene("box-grid:nx=2,ny=2,nz=2");
  tandem::ComparisonRequest request;
  request.backends = {"serial", "tbb:threads=2,lanes=4"};
  request.steps = 3;
  const tandem::Comparison same = tandem::compare_backends(scene, request);
  request.inject_fault = [](size_t world, uint64_t step, tandem::World &changed, const tandem::Launch &) {
    if (world != 1 || step != 1) return;
    tandem::BodyState body = changed.bodies()[1];
    body.linear_velocity[0] += 1;
    changed.set_body(1, body);
  };
  const tandem::Comparison other = tandem::compare_backends(scene, request);
  try {
    tandem::load_scene("no-such-scene");
    return 1;
  } catch (const tandem::InputError &error) { /* must be known on both sides of a shared library */
    std::printf("Tandem %s: %s\n", tandem::version(), error.what());
  }
  if (other.first_difference && other.first_difference->kernel && other.first_difference->buffer)
    std::printf("differs in %s of %s\n", tandem::name_of(*other.first_difference->buffer),
                tandem::name_of(*other.first_difference->kernel));
  return same.equal && same.steps == 3 && !other.equal ? 0 : 1;
}
