#pragma once

#include <string_view>
#include <vector>

#include "robot_api/http_request.hpp"
#include "robot_api/routes.hpp"

namespace ur_simulator::robot_api {

/// The parts of "a|b".
std::vector<std::string_view> split_choices(std::string_view choices);
/// "name" for a path that ends in "{name}", otherwise "".
std::string_view path_parameter(std::string_view path);

/// Checks a request and executes it. Errors of the request are answered like those of FastAPI, whose schemas
/// the Robot API has.
Answer execute_request(const HttpRequest & request, Pendant & pendant);

}  // namespace ur_simulator::robot_api
