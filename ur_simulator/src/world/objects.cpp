#include "world/objects.hpp"

#include <fmt/format.h>

#include "common/pose.hpp"
#include "world/requirements.hpp"

namespace ur_simulator {
namespace {

void check(const char * object, const Elasticity & elasticity)
{
  require_within(fmt::format("{}: stiffness (N/m)", object), elasticity.stiffness, 0.0, 1e7);
  require_within(fmt::format("{}: damping (N s/m)", object), elasticity.damping, 0.0, 1e5);
  require_within(fmt::format("{}: friction", object), elasticity.friction, 0.0, 10.0);
}

}  // namespace

Surface checked(const Surface & surface)
{
  require(is_finite(surface.point), "surface: point must be three finite numbers");
  require(is_finite(surface.normal) && surface.normal.norm() > 1e-9,
          "surface: normal must be three finite numbers, not all 0");
  check("surface", surface.elasticity);
  Surface result = surface;
  result.normal.normalize();
  return result;
}

Box checked(const Box & box)
{
  require(is_finite(box.center), "box: center must be three finite numbers");
  require(is_finite(box.rotation), "box: rotation must be three finite numbers");
  for (const double size : box.size) {
    require_within("box: size (m)", size, 1e-3, 100.0);
  }
  check("box", box.elasticity);
  return box;
}

Spring checked(const Spring & spring)
{
  require(is_finite(spring.anchor), "spring: anchor must be three finite numbers");
  require_within("spring: stiffness (N/m)", spring.stiffness, 0.0, 1e5);
  require_within("spring: damping (N s/m)", spring.damping, 0.0, 1e4);
  require_within("spring: length (m)", spring.length, 0.0, 100.0);
  return spring;
}

}  // namespace ur_simulator
