#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "polyscope/pendant.hpp"
#include "robot_api/reply.hpp"
#include "version/polyscope_version.hpp"

namespace ur_simulator::robot_api {

/// A checked request.
struct Call {
  Pendant & pendant;
  std::string parameter;  ///< decoded last part of the path, if the route has one
  nlohmann::json body;    ///< JSON body, if the route has fields
  std::string file;       ///< uploaded file, if the route takes one
};

/// A text field of a JSON body.
struct Field {
  std::string_view name;          ///< "": none
  std::string_view choices = {};  ///< valid values, separated by '|'; "": any text
  bool required = true;
};

enum class BodyType { none, json, file };

/// One route of the Robot API: an HTTP method and a path.
struct Route {
  std::string_view method;
  /// Path below the API's base path. A part "{name}" at the end is a parameter.
  std::string_view path;
  PolyscopeVersion since;
  bool requires_remote_control;
  Answer (*handle)(const Call & call);
  BodyType body_type = BodyType::none;
  std::array<Field, 2> fields = {};
};

constexpr std::string_view base_path = "/universal-robots/robot-api";
constexpr std::string_view file_field = "file";  ///< form field of an uploaded file

/// Version of the API that a version of PolyScope X offers.
std::string_view api_version(const PolyscopeVersion & version);
/// All operations, of all versions.
std::span<const Route> routes();

}  // namespace ur_simulator::robot_api
