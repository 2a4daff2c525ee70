#include "process/host_name_lock.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <functional>

namespace ur_ros_rtde {

/// An abstract Unix domain socket: the kernel accepts each address once and releases it with the process.
HostNameLock::HostNameLock(const std::string & name)
    : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0))
{
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  // The first byte of an abstract address is 0. A name that is too long is replaced by its hash.
  const std::string text =
      name.size() < sizeof(address.sun_path) ? name : std::to_string(std::hash<std::string>()(name));
  std::copy(text.begin(), text.end(), address.sun_path + 1);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
  const int result = ::bind(socket_, reinterpret_cast<const sockaddr *>(&address), size);
  taken_ = result != 0 && errno == EADDRINUSE;
}

HostNameLock::~HostNameLock()
{
  if (socket_ >= 0) {
    ::close(socket_);
  }
}

}  // namespace ur_ros_rtde
