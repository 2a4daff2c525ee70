#include "recording/recording_services.hpp"

#include <fmt/format.h>

#include <utility>

namespace ur_ros_rtde {

RecordingServices::RecordingServices(rcl_cxx::Node & node, const std::string & address, LogFunction log)
    : node_(node),
      recorder_(address, std::move(log)),
      start_recording_(node.create_service<Start>(
          "start_recording", [this](const auto & request, auto & response) { start(request, response); })),
      stop_recording_(node.create_service<Stop>("stop_recording",
                                                [this](const auto &, auto & response) { stop(response); }))
{
}

void RecordingServices::start(const Start::Request & request, Start::Response & response)
{
  const auto columns = recorder_.start(request.filename, request.fields, request.frequency);
  response.success = columns.has_value();
  if (columns) {
    response.columns = *columns;
    response.message = fmt::format("recording into {}", request.filename);
    RCL_CXX_INFO(node_.get_logger(), "{}", response.message);
  } else {
    response.message = columns.error().message;
    RCL_CXX_WARN(node_.get_logger(), "start_recording: {}", response.message);
  }
}

void RecordingServices::stop(Stop::Response & response)
{
  const auto report = recorder_.stop();
  if (!report) {
    response.message = report.error().message;
    return;
  }
  response.success = report->state.has_value();
  response.filename = report->file;
  response.rows = report->rows;
  response.lost = report->lost;
  response.message = report->state
                         ? fmt::format("{} rows, {} lost", report->rows, report->lost)
                         : fmt::format("{}, after {} rows", report->state.error().message, report->rows);
  RCL_CXX_INFO(node_.get_logger(), "{}: {}", report->file, response.message);
}

}  // namespace ur_ros_rtde
