#include "client_log/diagram_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace ur_simulator {
namespace {

int open_for_writing(const std::string & file)
{
  constexpr mode_t permissions = 0644;
  const int descriptor = file == "-"
                             ? ::dup(STDOUT_FILENO)
                             : ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, permissions);
  if (descriptor < 0) {
    throw std::runtime_error(
        fmt::format("client log '{}' cannot be written (--client-log): {}", file, std::strerror(errno)));
  }
  return descriptor;
}

/// In this thread, a write to a closed pipe fails instead of ending the process.
void block_pipe_signal()
{
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

}  // namespace

DiagramWriter::DiagramWriter(const std::string & file)
    : name_(file == "-" ? "standard output" : file),
      file_(open_for_writing(file)),
      queue_("sequenceDiagram\n"),
      thread_([this] { run(); })
{
}

DiagramWriter::~DiagramWriter()
{
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  changed_.notify_one();
  thread_.join();
  ::close(file_);
}

void DiagramWriter::add(std::string_view line)
{
  {
    const std::lock_guard lock(mutex_);
    if (failed_) {
      return;
    }
    if (queue_.size() + line.size() > queue_limit) {
      ++left_out_;
      return;
    }
    queue_.append(line).append("\n");
  }
  changed_.notify_one();
}

std::string DiagramWriter::take_lines()
{
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return closing_ || !queue_.empty(); });
  std::string lines = std::exchange(queue_, {});
  if (const std::uint64_t count = std::exchange(left_out_, 0); count > 0) {
    lines += fmt::format("%% {} lines left out: {} is too slow\n", count, name_);
  }
  return lines;
}

void DiagramWriter::run()
{
  block_pipe_signal();
  for (std::string lines = take_lines(); !lines.empty(); lines = take_lines()) {
    if (!write(lines)) {
      fmt::print(stderr, "ur_simulator: the client log ends: {} cannot be written: {}\n", name_,
                 std::strerror(errno));
      const std::lock_guard lock(mutex_);
      failed_ = true;
      return;
    }
  }
}

bool DiagramWriter::write(std::string_view bytes) const
{
  while (!bytes.empty()) {
    const ssize_t count = ::write(file_, bytes.data(), bytes.size());
    if (count < 0 && errno != EINTR) {
      return false;
    }
    bytes.remove_prefix(count < 0 ? 0 : static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace ur_simulator
