#include "ur_ros_rtde_robot/connection/rtde_subscription.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <string_view>
#include <utility>

#include "connection/big_endian.hpp"
#include "connection/ports.hpp"
#include "connection/rtde/rtde_header.hpp"
#include "connection/rtde/rtde_probe.hpp"
#include "ur_ros_rtde_robot/connection/tcp_socket.hpp"

namespace ur_ros_rtde {
namespace {

using Clock = RtdeSubscription::Clock;
using Bytes = std::span<const std::byte>;

/// Package types (UR, "RTDE Guide", "Protocol").
constexpr char protocol_version = 'V';
constexpr char setup_outputs = 'O';
constexpr char start = 'S';
constexpr char data = 'U';

enum class Kind { boolean, uint8, int32, uint32, uint64, real };

struct Layout {
  Kind kind;
  std::size_t count;
};

struct NamedLayout {
  std::string_view name;
  Layout layout;
};
constexpr std::array layouts{
    NamedLayout{"BOOL", {Kind::boolean, 1}},       NamedLayout{"UINT8", {Kind::uint8, 1}},
    NamedLayout{"INT32", {Kind::int32, 1}},        NamedLayout{"UINT32", {Kind::uint32, 1}},
    NamedLayout{"UINT64", {Kind::uint64, 1}},      NamedLayout{"DOUBLE", {Kind::real, 1}},
    NamedLayout{"VECTOR3D", {Kind::real, 3}},      NamedLayout{"VECTOR6D", {Kind::real, 6}},
    NamedLayout{"VECTOR6INT32", {Kind::int32, 6}}, NamedLayout{"VECTOR6UINT32", {Kind::uint32, 6}},
};

std::size_t bytes_of(Kind kind)
{
  switch (kind) {
    case Kind::boolean:
    case Kind::uint8:
      return 1;
    case Kind::int32:
    case Kind::uint32:
      return 4;
    default:
      return 8;
  }
}

double number(Kind kind, Bytes bytes)
{
  const std::uint64_t value = big_endian(bytes);
  switch (kind) {
    case Kind::boolean:
      return value != 0 ? 1.0 : 0.0;
    case Kind::int32:
      return static_cast<double>(static_cast<std::int32_t>(static_cast<std::uint32_t>(value)));
    case Kind::real:
      return std::bit_cast<double>(value);
    default:
      return static_cast<double>(value);
  }
}

std::vector<std::string> split(std::string_view list)
{
  std::vector<std::string> parts;
  while (true) {
    const std::size_t comma = list.find(',');
    parts.emplace_back(list.substr(0, comma));
    if (comma == std::string_view::npos) {
      return parts;
    }
    list.remove_prefix(comma + 1);
  }
}

std::string request(char type, std::string_view payload)
{
  const std::size_t size = rtde_header_size + payload.size();
  std::string package{static_cast<char>(size >> 8U), static_cast<char>(size & 0xFFU), type};
  return package.append(payload);
}

}  // namespace

class RtdeSubscription::Impl {
 public:
  Impl(TcpSocket socket, std::string name) : socket_(std::move(socket)), name_(std::move(name)) {}

  Status set_up(const std::vector<std::string> & names, double frequency, std::chrono::milliseconds timeout);
  Expected<bool> next(std::span<double> numbers, Clock::time_point deadline);

  std::vector<Field> fields_;
  std::size_t width_ = 0;
  double frequency_ = 0.0;

 private:
  struct Package {
    char type;
    Bytes payload;  ///< valid until the next call of package()
  };
  Expected<std::optional<Package>> package(Clock::time_point deadline);
  Expected<std::string> reply(char type, std::string_view payload, std::chrono::milliseconds timeout);
  Status set_layout(const std::vector<std::string> & names, const std::vector<std::string> & types);
  tl::unexpected<Error> protocol_error(const std::string & what) const
  {
    return failure(ErrorCode::link_lost, fmt::format("{} does not speak RTDE: {}", name_, what));
  }

  TcpSocket socket_;
  std::string name_;
  std::vector<Layout> layouts_;
  std::size_t package_bytes_ = 0;
  std::vector<std::byte> buffer_;
  std::size_t consumed_ = 0;  ///< bytes at the begin of buffer_ that have been processed
};

Expected<std::optional<RtdeSubscription::Impl::Package>> RtdeSubscription::Impl::package(
    Clock::time_point deadline)
{
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(consumed_));
  consumed_ = 0;
  std::array<std::byte, 2048> bytes;
  while (true) {
    if (buffer_.size() >= rtde_header_size) {
      const auto size = static_cast<std::size_t>(big_endian(Bytes(buffer_).first(2)));
      if (size < rtde_header_size) {
        return protocol_error(fmt::format("a package of {} bytes", size));
      }
      if (buffer_.size() >= size) {
        consumed_ = size;
        return Package{std::to_integer<char>(buffer_[2]),
                       Bytes(buffer_).subspan(rtde_header_size, size - rtde_header_size)};
      }
    }
    const auto got = socket_.read_some(bytes, deadline);
    if (!got) {
      return tl::unexpected(got.error());
    }
    if (*got == 0) {
      return std::nullopt;
    }
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(*got));
  }
}

/// Sends a request and waits for the reply, skipping text messages.
Expected<std::string> RtdeSubscription::Impl::reply(char type, std::string_view payload,
                                                    std::chrono::milliseconds timeout)
{
  const auto deadline = Clock::now() + timeout;
  if (const auto sent = socket_.write(request(type, payload), deadline); !sent) {
    return tl::unexpected(sent.error());
  }
  while (Clock::now() < deadline) {
    const auto answer = package(deadline);
    if (!answer) {
      return tl::unexpected(answer.error());
    }
    if (*answer && (*answer)->type == type) {
      const Bytes bytes = (*answer)->payload;
      return std::string(reinterpret_cast<const char *>(bytes.data()), bytes.size());
    }
  }
  return failure(ErrorCode::link_lost, fmt::format("{} does not answer", name_));
}

Status RtdeSubscription::Impl::set_layout(const std::vector<std::string> & names,
                                          const std::vector<std::string> & types)
{
  if (types.size() != names.size()) {
    return protocol_error(fmt::format("{} types for {} fields", types.size(), names.size()));
  }
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto known = std::ranges::find(layouts, types[i], &NamedLayout::name);
    if (types[i] == "NOT_FOUND") {
      missing.push_back(names[i]);
    } else if (known == layouts.end()) {
      return protocol_error(fmt::format("{} is of type \"{}\"", names[i], types[i]));
    } else {
      layouts_.push_back(known->layout);
      fields_.push_back({names[i], known->layout.count});
      width_ += known->layout.count;
      package_bytes_ += known->layout.count * bytes_of(known->layout.kind);
    }
  }
  if (!missing.empty()) {
    return failure(ErrorCode::not_supported,
                   fmt::format("this controller does not have {}", fmt::join(missing, ", ")));
  }
  return {};
}

Status RtdeSubscription::Impl::set_up(const std::vector<std::string> & names, double frequency,
                                      std::chrono::milliseconds timeout)
{
  frequency_ = frequency;
  if (const auto answer = reply(protocol_version, std::string_view("\0\2", 2), timeout); !answer) {
    return tl::unexpected(answer.error());
  } else if (*answer != "\1") {
    return protocol_error("it rejects protocol version 2, which PolyScope has had since 3.3");
  }
  std::string recipe(8, '\0');
  const auto bits = std::bit_cast<std::uint64_t>(frequency);
  for (std::size_t i = 0; i < recipe.size(); ++i) {
    recipe[i] = static_cast<char>(bits >> (56U - 8U * i) & 0xFFU);
  }
  const auto types = reply(setup_outputs, recipe + fmt::format("{}", fmt::join(names, ",")), timeout);
  if (!types) {
    return tl::unexpected(types.error());
  }
  if (types->empty()) {
    return protocol_error("the list of field types is empty");
  }
  if (Status layout_set = set_layout(names, split(std::string_view(*types).substr(1))); !layout_set) {
    return layout_set;
  }
  const auto started = reply(start, {}, timeout);
  if (!started) {
    return tl::unexpected(started.error());
  }
  return *started == "\1" ? Status() : protocol_error("it refuses to start");
}

Expected<bool> RtdeSubscription::Impl::next(std::span<double> numbers, Clock::time_point deadline)
{
  auto got = package(deadline);
  while (got && *got && (*got)->type != data && Clock::now() < deadline) {
    got = package(deadline);
  }
  if (!got) {
    return tl::unexpected(got.error());
  }
  if (!*got || (*got)->type != data) {
    return false;
  }
  Bytes bytes = (*got)->payload;
  if (bytes.size() != 1 + package_bytes_ || numbers.size() < width_) {
    return protocol_error(
        fmt::format("a package has {} bytes instead of {}", bytes.size(), 1 + package_bytes_));
  }
  bytes = bytes.subspan(1);  // recipe id
  std::size_t at = 0;
  for (const Layout & layout : layouts_) {
    for (std::size_t i = 0; i < layout.count; ++i) {
      numbers[at++] = number(layout.kind, bytes.first(bytes_of(layout.kind)));
      bytes = bytes.subspan(bytes_of(layout.kind));
    }
  }
  return true;
}

Expected<RtdeSubscription> RtdeSubscription::open(const std::string & address,
                                                  const std::vector<std::string> & fields, double frequency,
                                                  std::chrono::milliseconds timeout)
{
  const auto version = probe_rtde(address, timeout);
  if (!version) {
    return tl::unexpected(version.error());
  }
  auto socket = TcpSocket::connect(address, rtde_port, timeout);
  if (!socket) {
    return tl::unexpected(socket.error());
  }
  auto impl = std::make_unique<Impl>(std::move(*socket), fmt::format("{}:{}", address, rtde_port));
  const double maximum = version->frequency();
  if (const auto ready =
          impl->set_up(fields, frequency > 0.0 ? std::min(frequency, maximum) : maximum, timeout);
      !ready) {
    return tl::unexpected(ready.error());
  }
  return RtdeSubscription(std::move(impl));
}

RtdeSubscription::RtdeSubscription(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RtdeSubscription::RtdeSubscription(RtdeSubscription &&) noexcept = default;
RtdeSubscription & RtdeSubscription::operator=(RtdeSubscription &&) noexcept = default;
RtdeSubscription::~RtdeSubscription() = default;

const std::vector<RtdeSubscription::Field> & RtdeSubscription::fields() const
{
  return impl_->fields_;
}

std::size_t RtdeSubscription::width() const
{
  return impl_->width_;
}

double RtdeSubscription::frequency() const
{
  return impl_->frequency_;
}

std::chrono::milliseconds RtdeSubscription::silence_limit(std::chrono::milliseconds limit) const
{
  return ur_ros_rtde::silence_limit(limit, frequency());
}

Expected<bool> RtdeSubscription::next(std::span<double> numbers, Clock::time_point deadline)
{
  return impl_->next(numbers, deadline);
}

std::chrono::milliseconds silence_limit(std::chrono::milliseconds limit, double frequency)
{
  constexpr double periods = 5.0;
  return std::max(limit, std::chrono::ceil<std::chrono::milliseconds>(
                             std::chrono::duration<double>(periods / frequency)));
}

}  // namespace ur_ros_rtde
