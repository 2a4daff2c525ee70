#include "rcl_cxx/service.hpp"

#include <fmt/format.h>

#include "node_impl.hpp"
#include "qos_rmw.hpp"
#include "rcl_error.hpp"
#include "service_impl.hpp"

namespace rcl_cxx {
namespace detail {
std::shared_ptr<ServiceImpl> ServiceImpl::create(std::shared_ptr<NodeImpl> node, ErasedService erased,
                                                 const std::string & name, const QoS & qos)
{
  auto impl = std::make_shared<ServiceImpl>(std::move(node), std::move(erased), name, qos);
  check_rcl(rcl_service_set_on_new_request_callback(&impl->service_, &on_event, impl->source(0)),
            impl->label(), "its middleware does not report new requests");
  return impl;
}

ServiceImpl::ServiceImpl(std::shared_ptr<NodeImpl> node, ErasedService erased, const std::string & name,
                         const QoS & qos)
    : Waitable(std::move(node), fmt::format("service {}", name)),
      erased_(std::move(erased)),
      answers_(std::make_shared<ResponseRetry>(this->node())),
      service_(rcl_get_zero_initialized_service())
{
  rcl_service_options_t options = rcl_service_get_default_options();
  options.qos = to_rmw(qos);
  const std::lock_guard lock(this->node()->mutex());
  check_rcl(rcl_service_init(&service_, this->node()->handle(), erased_.type_support, name.c_str(), &options),
            label(), "cannot be created");
  name_ = rcl_service_get_service_name(&service_);
}

ServiceImpl::~ServiceImpl()
{
  const std::lock_guard lock(node()->mutex());
  ignore_rcl(rcl_service_fini(&service_, node()->handle()));
}

void ServiceImpl::execute(std::size_t /*source*/)
{
  const std::shared_ptr<void> request = erased_.make_request();
  rmw_request_id_t id;
  const rcl_ret_t code = rcl_take_request(&service_, &id, request.get());
  if (code == RCL_RET_SERVICE_TAKE_FAILED) {
    rcl_reset_error();
    return;
  }
  check_rcl(code, label(), "cannot take a request");
  const std::shared_ptr<void> response = erased_.make_response();
  try {
    erased_.callback(request.get(), response.get());
  } catch (...) {
    respond(id, response);  // a client must not hang because a server failed
    throw;
  }
  respond(id, response);
}

void ServiceImpl::respond(const rmw_request_id_t & id, const std::shared_ptr<void> & response)
{
  const auto self = std::static_pointer_cast<ServiceImpl>(shared_from_this());
  answers_->send(
      [self, id, response] {
        rmw_request_id_t to = id;
        return rcl_send_response(&self->service_, &to, response.get());
      },
      [self](rcl_ret_t code) {
        if (code != RCL_RET_OK) {
          RCL_CXX_WARN(self->node()->get_logger(), "{}: a response did not reach its client: {}", self->name_,
                       take_rcl_error());
        }
      });
}

void ServiceImpl::stop() noexcept
{
  ignore_rcl(rcl_service_set_on_new_request_callback(&service_, nullptr, nullptr));
  answers_->stop();
}
}  // namespace detail

ServiceBase::ServiceBase(std::shared_ptr<detail::ServiceImpl> impl) : impl_(std::move(impl)) {}
ServiceBase::~ServiceBase()
{
  impl_->close();
}
const std::string & ServiceBase::get_service_name() const noexcept
{
  return impl_->get_service_name();
}

}  // namespace rcl_cxx
