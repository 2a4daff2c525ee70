#include "rtde/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ur_simulator::rtde {
namespace {

constexpr std::uint8_t output_recipe_id = 1;
constexpr std::size_t most_input_recipes = 255;  // the id is one byte and 0 means "not valid"
constexpr double version_1_frequency = 125.0;

double highest_frequency(const PolyscopeVersion & version)
{
  return version.is_e_series() ? 500.0 : 125.0;
}

/// "a,b,": a trailing comma ends the list, it does not begin another name.
std::vector<std::string_view> split(std::string_view names)
{
  std::vector<std::string_view> parts;
  while (!names.empty()) {
    const std::size_t comma = names.find(',');
    parts.push_back(names.substr(0, comma));
    names.remove_prefix(comma == std::string_view::npos ? names.size() : comma + 1);
  }
  return parts;
}

std::string join(const std::vector<std::string> & parts)
{
  return fmt::format("{}", fmt::join(parts, ","));
}

std::string accepted(bool yes)
{
  return std::string(1, yes ? '\1' : '\0');
}

}  // namespace

Session::Session(std::shared_ptr<Connection> connection, Shared & shared)
    : connection_(std::move(connection)), shared_(shared), frequency_(highest_frequency(shared.version))
{
}

void Session::leave()
{
  started_ = false;
  std::erase_if(shared_.owners, [this](const auto & owner) { return owner.second == connection_->id(); });
  shared_.log.info("rtde", fmt::format("client {} disconnected", connection_->id()));
}

ClientRole Session::role() const
{
  if (inputs_.empty()) {
    return outputs_.empty() ? ClientRole::undecided : ClientRole::receive;
  }
  return outputs_.empty() ? ClientRole::io : ClientRole::control;
}

void Session::receive(std::string_view bytes)
{
  received_.append(bytes);
  std::size_t at = 0;
  while (connection_->open() && received_.size() - at >= header_size) {
    Reader header(std::string_view(received_).substr(at, header_size));
    const std::size_t size = header.u16();
    const std::uint8_t type = header.u8();
    if (size < header_size) {
      // The packages' ends cannot be found any more.
      shared_.log.error(
          "rtde", fmt::format("client {}: package size is {}, the header alone has {} bytes: disconnected",
                              connection_->id(), size, header_size));
      connection_->close();
      return;
    }
    if (received_.size() - at < size) {
      break;
    }
    handle(type, std::string_view(received_).substr(at + header_size, size - header_size));
    at += size;
  }
  received_.erase(0, at);
}

void Session::handle(std::uint8_t type, std::string_view payload)
{
  switch (static_cast<PackageType>(type)) {
    case PackageType::request_protocol_version:
      return request_protocol_version(payload);
    case PackageType::get_urcontrol_version:
      return get_urcontrol_version();
    case PackageType::text_message:
      return text_message(payload);
    case PackageType::data_package:
      return data_package(payload);
    case PackageType::setup_outputs:
      return setup_outputs(payload);
    case PackageType::setup_inputs:
      return setup_inputs(payload);
    case PackageType::start:
      return start_synchronisation();
    case PackageType::pause:
      started_ = false;
      return reply(PackageType::pause, accepted(true));
  }
  say(fmt::format("Unknown package type {}", type));
}

void Session::request_protocol_version(std::string_view payload)
{
  Reader reader(payload);
  const std::uint16_t version = reader.u16();
  const bool known = reader.ok() && (version == 1 || version == 2);
  if (known) {
    protocol_ = version;
  }
  reply(PackageType::request_protocol_version, accepted(known));
}

void Session::get_urcontrol_version()
{
  std::array<char, 16> payload;
  Writer writer(payload.data());
  for (const std::uint32_t part :
       {shared_.version.major, shared_.version.minor, shared_.version.bugfix, shared_.version.build}) {
    writer.put(part);
  }
  reply(PackageType::get_urcontrol_version, {payload.data(), payload.size()});
}

void Session::text_message(std::string_view payload)
{
  Reader reader(payload);
  std::string_view text;
  if (protocol_ == 1) {
    reader.u8();  // level
    text = reader.rest();
  } else {
    text = reader.bytes(reader.u8());
  }
  shared_.log.info("rtde", fmt::format("client {} says: {}", connection_->id(), text));
}

void Session::setup_outputs(std::string_view payload)
{
  Reader reader(payload);
  frequency_ = protocol_ == 1 ? version_1_frequency : reader.f64();
  const double highest = highest_frequency(shared_.version);
  if (!reader.ok() || !std::isfinite(frequency_) || frequency_ <= 0.0) {
    say(fmt::format("Output frequency must be above 0 and at most {} Hz", highest));
    frequency_ = highest;
  }
  frequency_ = std::min(frequency_, highest);

  outputs_.clear();
  outputs_valid_ = true;
  std::vector<std::string> types;
  std::size_t bytes = header_size + (protocol_ == 1 ? 0 : 1);
  for (const std::string_view name : split(reader.rest())) {
    const OutputField * field = find_output(name, shared_.version);
    types.emplace_back(field != nullptr ? rtde::name(field->type) : "NOT_FOUND");
    outputs_valid_ = outputs_valid_ && field != nullptr;
    if (field != nullptr) {
      outputs_.push_back(field);
      bytes += size(field->type);
    }
  }
  outputs_valid_ = outputs_valid_ && bytes <= 0xffff;
  package_.assign(outputs_valid_ ? bytes : 0, '\0');
  std::string answer = join(types);
  if (protocol_ != 1) {
    answer.insert(answer.begin(), static_cast<char>(outputs_valid_ ? output_recipe_id : 0));
  }
  reply(PackageType::setup_outputs, answer);
}

std::string Session::type_of(const InputField * field) const
{
  if (field == nullptr) {
    return "NOT_FOUND";
  }
  const auto owner = shared_.owners.find(field);
  const bool foreign = owner != shared_.owners.end() && owner->second != connection_->id();
  return foreign ? "IN_USE" : std::string(rtde::name(field->type));
}

void Session::claim(const std::vector<const InputField *> & fields)
{
  for (const InputField * field : fields) {
    shared_.owners[field] = connection_->id();
  }
}

void Session::setup_inputs(std::string_view payload)
{
  InputRecipe recipe;
  std::vector<std::string> types;
  bool valid = inputs_.size() < most_input_recipes;
  for (const std::string_view name : split(payload)) {
    const InputField * field = find_input(name, shared_.version);
    types.push_back(type_of(field));
    valid = valid && types.back() != "NOT_FOUND" && types.back() != "IN_USE";
    recipe.fields.push_back(field);
  }
  valid = valid && !recipe.fields.empty();
  std::uint8_t id = 0;
  if (valid) {
    claim(recipe.fields);
    inputs_.push_back(std::move(recipe));
    id = static_cast<std::uint8_t>(inputs_.size());
  }
  std::string answer = join(types);
  answer.insert(answer.begin(), static_cast<char>(id));
  reply(PackageType::setup_inputs, answer);
}

void Session::start_synchronisation()
{
  const bool can = outputs_valid_ && (!outputs_.empty() || !inputs_.empty());
  started_ = can;
  due_ = 1.0 - frequency_ / highest_frequency(shared_.version);
  reply(PackageType::start, accepted(can));
}

void Session::data_package(std::string_view payload)
{
  Reader reader(payload);
  const unsigned id = reader.u8();
  if (!reader.ok() || id == 0 || id > inputs_.size()) {
    shared_.log.warning(
        "rtde", fmt::format("client {}: data package for recipe {}, which was not set up (there are {})",
                            connection_->id(), id, inputs_.size()));
    return;
  }
  read_fields(inputs_[id - 1], reader.rest(), id);
}

void Session::read_fields(InputRecipe & recipe, std::string_view values, unsigned recipe_id)
{
  // Clients send packages that are longer or shorter than their recipe (ur_rtde does): the controller takes
  // the fields that are there, in order, and keeps the last value of the others.
  Reader reader(values);
  std::size_t expected = 0;
  std::size_t there = 0;
  for (const InputField * field : recipe.fields) {
    expected += size(field->type);
    if (reader.left() < size(field->type)) {
      reader.rest();
      continue;
    }
    field->read(reader, field->index, shared_.state, masked_);
    ++there;
  }
  apply(masked_, shared_.state);
  if (shared_.package_read) {
    shared_.package_read(std::span(recipe.fields).first(there));
  }
  if (expected != values.size() && !recipe.wrong_size_reported) {
    recipe.wrong_size_reported = true;
    shared_.log.warning("rtde",
                        fmt::format("client {}: data package for recipe {} has {} bytes, the recipe {}",
                                    connection_->id(), recipe_id, values.size(), expected));
  }
}

void Session::publish()
{
  if (!started_ || outputs_.empty()) {
    return;
  }
  const double cycles_per_second = highest_frequency(shared_.version);
  due_ += frequency_ / cycles_per_second;
  constexpr double rounding = 1e-9;
  if (due_ < 1.0 - rounding) {
    return;
  }
  due_ = std::fmod(due_ + rounding, 1.0) - rounding;

  Writer writer(package_.data());
  writer.put(static_cast<std::uint16_t>(package_.size()));
  writer.put(static_cast<std::uint8_t>(PackageType::data_package));
  if (protocol_ != 1) {
    writer.put(output_recipe_id);
  }
  for (const OutputField * field : outputs_) {
    field->write(shared_.state, field->index, writer);
  }
  dropped_packages_ += connection_->send_or_drop(package_) ? 0 : 1;
}

void Session::reply(PackageType type, std::string_view payload)
{
  std::string package(header_size + payload.size(), '\0');
  Writer writer(package.data());
  writer.put(static_cast<std::uint16_t>(package.size()));
  writer.put(static_cast<std::uint8_t>(type));
  writer.put(payload);
  connection_->send(package);
}

void Session::say(std::string_view text)
{
  shared_.log.warning("rtde", fmt::format("client {}: {}", connection_->id(), text));
  constexpr std::string_view source = "RTDE";
  constexpr std::uint8_t warning = 2;  // 0 exception, 1 error, 2 warning, 3 info
  text = text.substr(0, 255);          // the length is one byte
  if (protocol_ == 1) {
    reply(PackageType::text_message, static_cast<char>(warning) + std::string(text));
    return;
  }
  std::string payload(1, static_cast<char>(text.size()));
  payload += text;
  payload += static_cast<char>(source.size());
  payload += source;
  payload += static_cast<char>(warning);
  reply(PackageType::text_message, payload);
}

}  // namespace ur_simulator::rtde
