#pragma once

#include <fmt/format.h>
#include <rcl/error_handling.h>
#include <rcl/types.h>

#include <string>
#include <string_view>

#include "rcl_cxx/error.hpp"

namespace rcl_cxx::detail {
/// rcl's text of the last error of this thread, which is then reset.
inline std::string take_rcl_error()
{
  std::string text = rcl_error_is_set() ? rcl_get_error_string().str : "no details";
  rcl_reset_error();
  return text;
}

[[noreturn]] inline void throw_rcl_error(rcl_ret_t code, std::string_view entity, std::string_view action)
{
  throw Error(fmt::format("{}: {} (rcl error {}: {})", entity, action, code, take_rcl_error()), code);
}

/// Nothing is composed unless the call has failed.
inline void check_rcl(rcl_ret_t code, std::string_view entity, std::string_view action)
{
  if (code != RCL_RET_OK) {
    throw_rcl_error(code, entity, action);
  }
}

/// For destructors: an rcl object that cannot be finalised is leaked, there is nobody to tell.
inline void ignore_rcl(rcl_ret_t code) noexcept
{
  if (code != RCL_RET_OK) {
    rcl_reset_error();
  }
}

}  // namespace rcl_cxx::detail
