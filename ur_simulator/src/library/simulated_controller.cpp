#include "ur_simulator/simulated_controller.hpp"

#include <exception>
#include <future>
#include <optional>
#include <thread>
#include <utility>

#include "controller/controller.hpp"

namespace ur_simulator {
struct SimulatedController::Impl {
  explicit Impl(const SimulatorOptions & options_) : options(options_), controller(options_)
  {
    if (!options.client_log.empty()) {
      controller.start_client_log(client_log.emplace(options.client_log), "");
    }
    thread = std::thread([this] { controller.run(); });
  }
  ~Impl()
  {
    controller.stop();
    thread.join();
  }
  Impl(const Impl &) = delete;
  Impl & operator=(const Impl &) = delete;

  /// Runs the function on the controller's thread and returns its result or rethrows its exception.
  template <typename Function>
  auto call(Function function)
  {
    return controller.call(std::move(function)).get();
  }

  SimulatorOptions options;
  std::optional<DiagramWriter> client_log;
  Controller controller;
  std::thread thread;
};

SimulatedController::SimulatedController(const SimulatorOptions & options)
    : impl_(std::make_unique<Impl>(options))
{
}

SimulatedController::~SimulatedController() = default;

const std::string & SimulatedController::address() const
{
  return impl_->options.address;
}

Ports SimulatedController::ports() const
{
  return impl_->controller.ports();
}

nlohmann::json SimulatedController::control(const nlohmann::json & request)
{
  return impl_->call([&] { return impl_->controller.control(request); });
}

nlohmann::json SimulatedController::state()
{
  return impl_->call([&] { return impl_->controller.state(); });
}

bool SimulatedController::wait_until(const std::function<bool(const nlohmann::json &)> & condition,
                                     std::chrono::milliseconds timeout)
{
  // Shared with the observer, which may outlive this call by one cycle.
  struct Wait {
    std::promise<void> reached;
    std::function<bool(const nlohmann::json &)> condition;
    bool timed_out = false;  // accessed on the controller's thread only
  };
  auto wait = std::make_shared<Wait>();
  wait->condition = condition;
  auto reached = wait->reached.get_future();
  Controller & controller = impl_->controller;
  const auto observe = [wait, &controller] {
    if (wait->timed_out) {
      return true;
    }
    try {
      if (!wait->condition(controller.state())) {
        return false;
      }
      wait->reached.set_value();
    } catch (...) {
      wait->reached.set_exception(std::current_exception());
    }
    return true;
  };
  impl_->call([&] {
    if (!observe()) {
      controller.add_observer(observe);
    }
  });
  if (reached.wait_for(timeout) == std::future_status::ready) {
    reached.get();
    return true;
  }
  // The observer does not use the condition and its references anymore.
  impl_->call([&] { wait->timed_out = true; });
  const bool meanwhile = reached.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  if (meanwhile) {
    reached.get();
  }
  return meanwhile;
}

}  // namespace ur_simulator
