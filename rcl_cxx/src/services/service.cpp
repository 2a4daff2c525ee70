#include "rcl_cxx/service.hpp"

#include <fmt/format.h>
#include <rcl/service.h>

#include "executor/waitable.hpp"
#include "node/node_impl.hpp"
#include "rcl_support/rcl_error.hpp"
#include "rcl_support/type_support.hpp"
#include "services/response_sender.hpp"
#include "services/service_clients.hpp"

namespace rcl_cxx {
namespace detail {
class ServiceImpl : public Waitable {
 public:
  ServiceImpl(std::shared_ptr<NodeImpl> node, ErasedService erased, const std::string & name, const QoS & qos,
              CallbackGroup::SharedPtr group);
  ~ServiceImpl() override;

  const std::string & get_service_name() const noexcept { return name_; }

  void set_on_ready_callbacks() override
  {
    set_callback(rcl_service_set_on_new_request_callback, service_, 0);
  }

 protected:
  void execute(std::size_t source) override;
  void clear_on_ready_callbacks() noexcept override;

 private:
  void respond(const rmw_request_id_t & id, const std::shared_ptr<void> & response);
  rcl_ret_t send(rmw_request_id_t id, void * response) { return rcl_send_response(&service_, &id, response); }

  const CallbackGroup & group(std::size_t) const override { return *group_; }

  const ErasedService erased_;
  const ServiceTypeSupport type_support_;
  const CallbackGroup::SharedPtr group_;
  const std::shared_ptr<ResponseSender> sender_;
  rcl_service_t service_ = rcl_get_zero_initialized_service();
  std::string name_;
};

ServiceImpl::ServiceImpl(std::shared_ptr<NodeImpl> node, ErasedService erased, const std::string & name,
                         const QoS & qos, CallbackGroup::SharedPtr group)
    : Waitable(std::move(node), fmt::format("service {}", name)),
      erased_(std::move(erased)),
      type_support_(erased_.type_support),
      group_(group ? std::move(group) : this->node()->default_group()),
      sender_(std::make_shared<ResponseSender>(this->node(), group_))
{
  rcl_service_options_t options = rcl_service_get_default_options();
  options.qos = qos.get_rmw_qos_profile();
  const auto lock = this->node()->lock_to_create(label());
  check_rcl(rcl_service_init(&service_, this->node()->handle(), type_support_.get(), name.c_str(), &options),
            label(), "cannot be created");
  reset_type_support_error();
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
    respond(id, response);
    throw;
  }
  respond(id, response);
}

void ServiceImpl::respond(const rmw_request_id_t & id, const std::shared_ptr<void> & response)
{
  const auto self = std::static_pointer_cast<ServiceImpl>(shared_from_this());
  sender_->send({[self, id, response] { return self->send(id, response.get()); },
                 [self, id] { return self->send(id, self->erased_.make_response().get()); },
                 [self, id] { return discovery_of(id, *self->node(), self->name_); },
                 [self](rcl_ret_t code) {
                   if (code != RCL_RET_OK) {
                     RCL_CXX_WARN(self->node()->get_logger(), "{}: a response was not delivered: {}",
                                  self->name_, take_rcl_error());
                   }
                 }});
}

void ServiceImpl::clear_on_ready_callbacks() noexcept
{
  clear_callback(rcl_service_set_on_new_request_callback, service_);
  sender_->stop();
}
}  // namespace detail

ServiceBase::ServiceBase(std::shared_ptr<detail::NodeImpl> node, detail::ErasedService erased,
                         const std::string & name, const QoS & qos, CallbackGroup::SharedPtr group)
    : impl_(detail::make_waitable<detail::ServiceImpl>(std::move(node), std::move(erased), name, qos,
                                                       std::move(group)))
{
}
ServiceBase::~ServiceBase()
{
  impl_->close();
}
const std::string & ServiceBase::get_service_name() const noexcept
{
  return impl_->get_service_name();
}

}  // namespace rcl_cxx
