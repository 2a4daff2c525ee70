#include "type_description_service.hpp"

#include <rcl/service.h>

#include "node_impl.hpp"
#include "rcl_compat.hpp"
#include "rcl_error.hpp"

namespace rcl_cxx::detail {
#if RCL_CXX_HAS_TYPE_DESCRIPTION_SERVICE
namespace {
/// rcl makes the service, with the C types, and composes the answers.
class Impl : public Waitable {
 public:
  explicit Impl(const std::shared_ptr<NodeImpl> & owner)
      : Waitable(owner, "service get_type_description"), service_(rcl_get_zero_initialized_service())
  {
    const std::lock_guard lock(node()->mutex());
    check_rcl(rcl_node_type_description_service_init(&service_, node()->handle()), label(),
              "cannot be created");
  }

  ~Impl() override
  {
    const std::lock_guard lock(node()->mutex());
    ignore_rcl(rcl_service_fini(&service_, node()->handle()));
  }

  void start()
  {
    check_rcl(rcl_service_set_on_new_request_callback(&service_, &on_event, source(0)), label(),
              "its middleware does not report new requests");
  }

 protected:
  void stop() noexcept override
  {
    ignore_rcl(rcl_service_set_on_new_request_callback(&service_, nullptr, nullptr));
  }

  void execute(std::size_t /*source*/) override
  {
    const std::unique_ptr<Request, decltype(&destroy_request)> request(create_request(), &destroy_request);
    const std::unique_ptr<Response, decltype(&destroy_response)> response(create_response(),
                                                                          &destroy_response);
    rmw_request_id_t id;
    const rcl_ret_t code = rcl_take_request(&service_, &id, request.get());
    if (code == RCL_RET_SERVICE_TAKE_FAILED) {
      rcl_reset_error();
      return;
    }
    check_rcl(code, label(), "cannot take a request");
    {
      const std::lock_guard lock(node()->mutex());  // reads the table of types that every new entity adds to
      rcl_node_type_description_service_handle_request(node()->handle(), &id, request.get(), response.get());
    }
    check_rcl(rcl_send_response(&service_, &id, response.get()), label(), "cannot send the response");
  }

 private:
  using Request = type_description_interfaces__srv__GetTypeDescription_Request;
  using Response = type_description_interfaces__srv__GetTypeDescription_Response;
  static Request * create_request()
  {
    return type_description_interfaces__srv__GetTypeDescription_Request__create();
  }
  static void destroy_request(Request * r)
  {
    type_description_interfaces__srv__GetTypeDescription_Request__destroy(r);
  }
  static Response * create_response()
  {
    return type_description_interfaces__srv__GetTypeDescription_Response__create();
  }
  static void destroy_response(Response * r)
  {
    type_description_interfaces__srv__GetTypeDescription_Response__destroy(r);
  }

  rcl_service_t service_;
};
}  // namespace

TypeDescriptionService::TypeDescriptionService(const std::shared_ptr<NodeImpl> & node,
                                               Parameters & parameters)
{
  ParameterDescriptor options;
  options.description = "Start the ~/get_type_description service for this node.";
  options.read_only = true;
  if (parameters.declare("start_type_description_service", true, options).get<bool>()) {
    auto impl = std::make_shared<Impl>(node);
    impl->start();
    impl_ = std::move(impl);
  }
}
#else
TypeDescriptionService::TypeDescriptionService(const std::shared_ptr<NodeImpl> &, Parameters &) {}
#endif

TypeDescriptionService::~TypeDescriptionService()
{
  if (impl_) {
    impl_->close();
  }
}

}  // namespace rcl_cxx::detail
