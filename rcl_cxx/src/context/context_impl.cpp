#include "context/context_impl.hpp"

#include <fmt/format.h>
#include <rcl/arguments.h>
#include <rcl/init.h>
#include <rcl/init_options.h>

#include <csignal>
#include <cstring>

#include "context/arguments.hpp"
#include "context/logging_impl.hpp"
#include "rcl_cxx/logging.hpp"
#include "rcl_support/rcl_error.hpp"

namespace rcl_cxx::detail {
namespace {
const Logger & context_logger()
{
  static const Logger logger("rcl_cxx");
  return logger;
}
}  // namespace

ContextImpl::ContextImpl(const std::vector<std::string> & arguments, const InitOptions & options)
    : signal_grace_(options.signal_grace)
{
  std::vector<const char *> argv;
  for (const std::string & argument : arguments) {
    argv.push_back(argument.c_str());
  }
  init(argv);
  try {
    check_ros_arguments(context_.global_arguments, argv.data());
    non_ros_arguments_ = remove_ros_arguments(context_.global_arguments, argv.data());
    if (options.auto_initialize_logging) {
      logging_ = configure_logging(context_.global_arguments);
    }
  } catch (...) {
    ignore_rcl(rcl_shutdown(&context_));
    ignore_rcl(rcl_context_fini(&context_));
    throw;
  }
}

void ContextImpl::init(const std::vector<const char *> & argv)
{
  rcl_init_options_t options = rcl_get_zero_initialized_init_options();
  check_rcl(rcl_init_options_init(&options, rcl_get_default_allocator()), "context", "cannot be created");
  const rcl_ret_t code = rcl_init(static_cast<int>(argv.size()), argv.data(), &options, &context_);
  const std::string details = code == RCL_RET_OK ? "" : take_rcl_error();
  ignore_rcl(rcl_init_options_fini(&options));
  if (code != RCL_RET_OK) {
    if (context_.impl != nullptr) {
      ignore_rcl(rcl_context_fini(&context_));
    }
    throw Error(
        fmt::format("context: rcl cannot start, check the ROS arguments and environment variables: {}",
                    details),
        code);
  }
}

ContextImpl::~ContextImpl()
{
  // The constructor of Context may have failed.
  if (rcl_context_is_valid(&context_)) {
    ignore_rcl(rcl_shutdown(&context_));
  }
  ignore_rcl(rcl_context_fini(&context_));
}

void ContextImpl::watch_signals()
{
  signals_ = SignalWatcher::instance();
  // A weak pointer: the watcher may call until remove() has returned.
  signal_id_ = signals_->add([weak = weak_from_this()](int signal) {
    if (const auto impl = weak.lock()) {
      impl->on_signal(signal);
    }
  });
}

void ContextImpl::join_signal_thread()
{
  if (signals_) {
    signals_->remove(signal_id_);
  }
  std::thread thread;
  {
    const std::lock_guard lock(mutex_);
    thread.swap(signal_thread_);
  }
  if (thread.joinable()) {
    if (thread.get_id() == std::this_thread::get_id()) {
      thread.detach();  // a shutdown callback has released the Context; the thread holds a reference to this
    } else {
      thread.join();
    }
  }
  signals_.reset();
}

void ContextImpl::on_signal(int signal)
{
  const std::string name = fmt::format("SIG{}", ::sigabbrev_np(signal));
  const auto now = std::chrono::steady_clock::now();
  const std::lock_guard lock(mutex_);
  if (!first_signal_) {
    first_signal_ = now;
    signal_thread_ = std::thread([self = shared_from_this(), name] { self->shutdown(name); });
  } else if (now - *first_signal_ > signal_grace_) {
    take_default_action(signal);
  } else {
    RCL_CXX_INFO(context_logger(), "{} ignored: the shutdown is in progress", name);
  }
}

bool ContextImpl::shutdown(const std::string & reason)
{
  // A callback may release the Context, and spin() returns before this function does.
  const auto self = shared_from_this();
  {
    const std::lock_guard lock(mutex_);
    if (state_.load() != State::running) {
      return false;
    }
    reason_ = reason;
    state_ = State::shutting_down;
  }
  state_changed_.notify_all();
  run_callbacks(Phase::pre_shutdown);
  run_callbacks(Phase::action_servers);
  run_callbacks(Phase::rosout);
  const rcl_ret_t code = [this] {
    const std::lock_guard no_creation(creation_mutex_);
    return rcl_shutdown(&context_);
  }();
  if (code != RCL_RET_OK) {
    RCL_CXX_ERROR(context_logger(), "shutdown: {}", take_rcl_error());
  }
  run_callbacks(Phase::on_shutdown);
  set_state(State::shut_down);
  return true;
}

std::string ContextImpl::shutdown_reason() const
{
  const std::lock_guard lock(mutex_);
  return reason_;
}

bool ContextImpl::wait_for(std::chrono::nanoseconds timeout, bool complete) const
{
  std::unique_lock lock(mutex_);
  return state_changed_.wait_for(lock, timeout, [&] {
    const State state = state_.load();
    return state == State::shut_down || (!complete && state == State::shutting_down);
  });
}

void ContextImpl::set_state(State state)
{
  {
    const std::lock_guard lock(mutex_);
    state_ = state;
  }
  state_changed_.notify_all();
}

std::size_t ContextImpl::add_callback(Phase phase, Context::Callback callback)
{
  {
    const std::lock_guard lock(mutex_);
    const bool too_late = state_.load() != State::running && phase <= reached_;
    const std::size_t id = ++next_id_;
    if (!too_late) {
      callbacks_.emplace(Key{phase, id}, std::move(callback));
      return id;
    }
  }
  run_callback(callback);
  return 0;
}

void ContextImpl::remove_callback(std::size_t id)
{
  // Without mutex_, which a running callback may need.
  const std::lock_guard wait_for_running(running_callback_);
  const std::lock_guard lock(mutex_);
  std::erase_if(callbacks_, [id](const auto & entry) { return entry.first.second == id; });
}

void ContextImpl::run_callbacks(Phase phase)
{
  std::size_t last = 0;
  while (true) {
    const std::lock_guard running(running_callback_);
    Context::Callback callback;
    {
      const std::lock_guard lock(mutex_);
      const auto next = callbacks_.upper_bound(Key{phase, last});
      if (next == callbacks_.end() || next->first.first != phase) {
        reached_ = phase;
        return;
      }
      last = next->first.second;
      callback = next->second;
    }
    run_callback(callback);
  }
}

void ContextImpl::run_callback(const Context::Callback & callback) noexcept
{
  try {
    callback();
  } catch (const std::exception & error) {
    RCL_CXX_ERROR(context_logger(), "a shutdown callback failed: {}", error.what());
  } catch (...) {
    RCL_CXX_ERROR(context_logger(), "a shutdown callback threw an unknown exception");
  }
}

}  // namespace rcl_cxx::detail
