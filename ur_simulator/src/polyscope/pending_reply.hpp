#pragma once

#include <functional>
#include <optional>
#include <string>

namespace ur_simulator {

/// A dashboard reply that may take several control cycles. Polled once per cycle; returns nullopt until the
/// reply is available.
using PendingReply = std::function<std::optional<std::string>()>;

}  // namespace ur_simulator
