#pragma once

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

// The peer of all sockets of a fuzz target: functions of the C library are replaced within the program, so
// that clients run unchanged and receive bytes without a network. Include it in one file. Single-threaded.

namespace ur_fuzz {

constexpr const char * address = "127.0.0.1";

/// What each connection receives: these bytes, at most `piece` at a time, then the end of the stream.
struct Replies {
  std::string_view bytes;
  std::size_t piece;

  std::size_t read(void * data, std::size_t size)
  {
    const std::size_t count = std::min({size, bytes.size(), piece});
    std::copy_n(bytes.data(), count, static_cast<char *>(data));
    bytes.remove_prefix(count);
    return count;
  }
};

inline Replies replies{};  ///< of the next connection
inline Replies unread{};   ///< of the current connection

/// `bytes` must remain valid. Piece 0: any size.
inline void set_replies(std::string_view bytes, std::size_t piece)
{
  replies = {bytes, piece == 0 ? bytes.size() : piece};
}

}  // namespace ur_fuzz

extern "C" {

int connect(int, const sockaddr *, socklen_t)
{
  ur_fuzz::unread = ur_fuzz::replies;
  return 0;
}

ssize_t recv(int, void * data, std::size_t size, int)
{
  return static_cast<ssize_t>(ur_fuzz::unread.read(data, size));
}

ssize_t recvmsg(int, msghdr * message, int)
{
  std::size_t count = 0;
  for (std::size_t i = 0; i < message->msg_iovlen; ++i) {
    count += ur_fuzz::unread.read(message->msg_iov[i].iov_base, message->msg_iov[i].iov_len);
  }
  return static_cast<ssize_t>(count);
}

ssize_t send(int, const void *, std::size_t size, int)
{
  return static_cast<ssize_t>(size);
}

ssize_t sendmsg(int, const msghdr * message, int)
{
  std::size_t count = 0;
  for (std::size_t i = 0; i < message->msg_iovlen; ++i) {
    count += message->msg_iov[i].iov_len;
  }
  return static_cast<ssize_t>(count);
}

/// All sockets can be read and written.
int poll(pollfd * sockets, nfds_t count, int)
{
  for (nfds_t i = 0; i < count; ++i) {
    sockets[i].revents = static_cast<short>(sockets[i].events & (POLLIN | POLLOUT));
  }
  return static_cast<int>(count);
}

}  // extern "C"
