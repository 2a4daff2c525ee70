#pragma once

#include <nlohmann/json.hpp>

#include "version/polyscope_version.hpp"

namespace ur_simulator::robot_api {

/// The description of the API in this version, in the format of OpenAPI 3.1.
nlohmann::json openapi_document(const PolyscopeVersion & version);

}  // namespace ur_simulator::robot_api
