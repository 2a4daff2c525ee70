#include "script_api/robot_context.hpp"

// Settings that programs can read back. The simulator does not model their effect.

namespace ur_simulator::script_api {

namespace {

/// Kept from one program to the next.
struct StoredSettings {
  Vector3 base_acceleration = Vector3::Zero();  ///< m/s^2
  double jerk_gain_scaling = 1.0;
  std::int32_t motion_version = 1;
};

using StoredSettingsPtr = std::shared_ptr<StoredSettings>;

Outcome set_base_acceleration(StoredSettings & settings, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const Vector3 acceleration = reader.vector3(0, "a");
  if (!reader) {
    return reader.failure();
  }
  settings.base_acceleration = acceleration;
  return Value();
}

Outcome set_jerk_gain_scaling(StoredSettings & settings, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const double gain = reader.number(0, "gain");
  reader.require(gain > 0.0, fmt::format("gain must be positive, is {}", gain));
  if (!reader) {
    return reader.failure();
  }
  settings.jerk_gain_scaling = gain;
  return Value();
}

Outcome set_motion_version(StoredSettings & settings, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::int32_t version = reader.integer(0, "version");
  reader.require(version == 1 || version == 2, fmt::format("version must be 1 or 2, is {}", version));
  if (!reader) {
    return reader.failure();
  }
  settings.motion_version = version;
  return Value();
}

}  // namespace

void add_stored_setting_builtins(Library & library)
{
  const auto settings = std::make_shared<StoredSettings>();
  const auto add_setter = [&](const char * name, const char * parameter,
                              Outcome (*set)(StoredSettings &, Arguments), const char * note) {
    library.add({name, {parameter}, 1, [settings, set](CallContext &, Arguments arguments) {
                   return set(*settings, arguments);
                 }});
    library.simplify(name, note);
  };
  const auto add_getter = [&](const char * name, Value (*get)(const StoredSettings &)) {
    library.add(
        {name, {}, 0, [settings, get](CallContext &, Arguments) -> Outcome { return get(*settings); }});
  };
  add_setter("set_base_acceleration", "a", set_base_acceleration, "stored; the base of the arm stands still");
  add_setter("jerk_gain_scaling_set", "gain", set_jerk_gain_scaling,
             "stored; motions are not limited in jerk");
  add_setter("motion_version_set", "version", set_motion_version, "stored; there is one motion planner");
  add_getter("get_base_acceleration",
             [](const StoredSettings & s) { return Value::list(s.base_acceleration); });
  add_getter("jerk_gain_scaling_get", [](const StoredSettings & s) { return Value(s.jerk_gain_scaling); });
  add_getter("motion_version_get", [](const StoredSettings & s) { return Value(s.motion_version); });
}

}  // namespace ur_simulator::script_api
