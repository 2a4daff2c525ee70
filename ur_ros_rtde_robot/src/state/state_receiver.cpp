#include "ur_ros_rtde_robot/state/state_receiver.hpp"

#include "state/state_receiver_impl.hpp"

namespace ur_ros_rtde {

StateReceiver::StateReceiver(StateReceiverOptions options, LogFunction log)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(log)))
{
}

StateReceiver::~StateReceiver()
{
  stop();
}

void StateReceiver::on_sample(SampleFunction function)
{
  impl_->sample_function_ = std::move(function);
}

void StateReceiver::on_link(LinkFunction function)
{
  impl_->link_function_ = std::move(function);
}

void StateReceiver::start()
{
  if (!impl_->thread_.joinable()) {
    impl_->thread_ = std::jthread([impl = impl_.get()](const std::stop_token & stop) { impl->run(stop); });
  }
}

void StateReceiver::stop()
{
  if (impl_->thread_.joinable()) {
    impl_->thread_.request_stop();
    impl_->thread_.join();
  }
}

LinkStatus StateReceiver::link() const
{
  const std::lock_guard lock(impl_->mutex_);
  return impl_->link_;
}

std::optional<ControllerVersion> StateReceiver::version() const
{
  const std::lock_guard lock(impl_->mutex_);
  return impl_->version_;
}

double StateReceiver::frequency() const
{
  const std::lock_guard lock(impl_->mutex_);
  return impl_->frequency_;
}

std::optional<Sample> StateReceiver::latest() const
{
  const std::lock_guard lock(impl_->mutex_);
  return impl_->latest_.sequence == 0 ? std::nullopt : std::optional(impl_->latest_);
}

bool StateReceiver::wait_for_next(Sample & last, std::chrono::milliseconds timeout,
                                  std::stop_token stop) const
{
  std::unique_lock lock(impl_->mutex_);
  const bool newer =
      impl_->changed_.wait_for(lock, stop, timeout, [&] { return impl_->latest_.sequence > last.sequence; });
  if (newer) {
    last = impl_->latest_;
  }
  return newer;
}

Locked<ur_rtde::RTDEReceiveInterface> StateReceiver::receive() const
{
  return impl_->receive();
}

}  // namespace ur_ros_rtde
