#include <fmt/format.h>

#include <algorithm>

#include "urscript/interpreter/containers.hpp"

namespace ur_simulator::urscript {

namespace {

using Arguments = std::span<const Value>;

struct Method {
  const char * name;
  std::size_t arguments;
  Result (*function)(Value & list, Arguments arguments);
};

Result length(Value & list, Arguments)
{
  return Value(static_cast<std::int32_t>(list.list().size()));
}

Result capacity(Value &, Arguments)
{
  return Value(static_cast<std::int32_t>(element_limit));
}

tl::expected<std::size_t, std::string> insertion_index(const Value & index, std::size_t end)
{
  if (!index.is(Type::integer) || index.integer() < 0 || static_cast<std::size_t>(index.integer()) > end) {
    return tl::unexpected(fmt::format("index {} is out of range", index.text()));
  }
  return static_cast<std::size_t>(index.integer());
}

Result insert_at(Value & list, std::size_t where, const Value & value)
{
  if (element_count(list) + element_count(value) > element_limit) {
    return tl::unexpected(fmt::format("a list must have at most {} elements", element_limit));
  }
  // Copied first: the value may be the list itself.
  Value element = value;
  List & elements = list.own_list();
  elements.insert(elements.begin() + static_cast<std::ptrdiff_t>(where), std::move(element));
  return Value();
}

Result append(Value & list, Arguments arguments)
{
  return insert_at(list, list.list().size(), arguments[0]);
}

Result insert(Value & list, Arguments arguments)
{
  const auto where = insertion_index(arguments[0], list.list().size());
  return where ? insert_at(list, *where, arguments[1]) : Result(tl::unexpected(where.error()));
}

Result remove(Value & list, Arguments arguments)
{
  const auto where = insertion_index(arguments[0], list.list().size());
  if (!where || *where == list.list().size()) {
    return tl::unexpected(fmt::format("index {} is out of range", arguments[0].text()));
  }
  List & elements = list.own_list();
  elements.erase(elements.begin() + static_cast<std::ptrdiff_t>(*where));
  return Value();
}

Result pop(Value & list, Arguments)
{
  if (list.list().empty()) {
    return tl::unexpected<std::string>("pop() of an empty list");
  }
  List & elements = list.own_list();
  Value last = std::move(elements.back());
  elements.pop_back();
  return last;
}

Result clear(Value & list, Arguments)
{
  list.own_list().clear();
  return Value();
}

Result extend(Value & list, Arguments arguments)
{
  if (!arguments[0].is(Type::list)) {
    return tl::unexpected<std::string>("Type error: extend() takes a list");
  }
  if (element_count(list) + element_count(arguments[0]) > element_limit) {
    return tl::unexpected(fmt::format("a list must have at most {} elements", element_limit));
  }
  const List added = arguments[0].list();
  List & elements = list.own_list();
  elements.insert(elements.end(), added.begin(), added.end());
  return Value();
}

Result slice(Value & list, Arguments arguments)
{
  const std::size_t size = list.list().size();
  const auto begin = insertion_index(arguments[0], size);
  const auto end = insertion_index(arguments[1], size);
  if (!begin || !end || *begin > *end) {
    return tl::unexpected(fmt::format("slice({}, {}) of a list of {} elements", arguments[0].text(),
                                      arguments[1].text(), size));
  }
  const auto first = list.list().begin();
  return Value(List(first + static_cast<std::ptrdiff_t>(*begin), first + static_cast<std::ptrdiff_t>(*end)));
}

constexpr Method methods[] = {
    {"length", 0, length}, {"capacity", 0, capacity}, {"append", 1, append},
    {"insert", 2, insert}, {"remove", 1, remove},     {"pop", 0, pop},
    {"clear", 0, clear},   {"extend", 1, extend},     {"slice", 2, slice},
};

}  // namespace

Result call_method(Value & object, const std::string & method, std::span<const Value> arguments)
{
  if (method == "to_string" && arguments.empty()) {
    return Value(object.text());
  }
  const auto found = std::find_if(std::begin(methods), std::end(methods),
                                  [&](const Method & m) { return method == m.name; });
  if (found == std::end(methods) || !object.is(Type::list)) {
    return tl::unexpected(fmt::format("a {} has no method '{}'", name_of(object.type()), method));
  }
  if (arguments.size() != found->arguments) {
    return tl::unexpected(fmt::format("the method '{}' takes {} arguments, {} are given", method,
                                      found->arguments, arguments.size()));
  }
  return found->function(object, arguments);
}

}  // namespace ur_simulator::urscript
