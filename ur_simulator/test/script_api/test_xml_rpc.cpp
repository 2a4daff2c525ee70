#include <gtest/gtest.h>

#include "script_api/xml_rpc.hpp"

namespace ur_simulator {
namespace {

using urscript::Type;
using urscript::Value;

std::string response(const std::string & value)
{
  return "<?xml version=\"1.0\"?>\n<methodResponse>\n <params>\n  <param>\n   <value>" + value +
         "</value>\n  </param>\n </params>\n</methodResponse>\n";
}

std::string parsed(const std::string & value)
{
  const auto result = parse_xml_rpc_response(response(value));
  return result ? result->text() : result.error();
}

std::string encoded(const Value & value)
{
  const std::string request = xml_rpc_request("f", std::span(&value, 1));
  const std::size_t begin = request.find("<param>") + 7;
  return request.substr(begin, request.find("</param>") - begin);
}

TEST(XmlRpcTest, EncodesRequests)
{
  const std::vector<Value> arguments{Value(true), Value(-3), Value(0.25), Value("a<b & c")};
  EXPECT_EQ(xml_rpc_request("initialize", arguments),
            "<?xml version=\"1.0\"?><methodCall><methodName>initialize</methodName><params>"
            "<param><value><boolean>1</boolean></value></param><param><value><int>-3</int></value></param>"
            "<param><value><double>0.25</double></value></param>"
            "<param><value><string>a&lt;b &amp; c</string></value></param></params></methodCall>");
}

TEST(XmlRpcTest, APoseIsAStructure)
{
  const Value pose = Value::pose((Vector6() << 1, 2, 3, 0.5, -0.5, 0).finished());
  const std::string value = encoded(pose);
  EXPECT_TRUE(value.starts_with("<value><struct><member><name>x</name><value><double>1</double></value>"))
      << value;
  EXPECT_NE(value.find("<name>ry</name><value><double>-0.5</double>"), std::string::npos);
  EXPECT_EQ(parsed(value.substr(7, value.size() - 15)), "p[1, 2, 3, 0.5, -0.5, 0]");
}

TEST(XmlRpcTest, DecodesEachType)
{
  EXPECT_EQ(parsed("<int> 42 </int>"), "42");
  EXPECT_EQ(parsed("<i4>-7</i4>"), "-7");
  EXPECT_EQ(parsed("<boolean>0</boolean>"), "False");
  EXPECT_EQ(parsed("<double>1.5e-1</double>"), "0.15");
  EXPECT_EQ(parsed("<string>a &lt; b</string>"), "a < b");
  EXPECT_EQ(parsed("no type"), "no type");
  EXPECT_EQ(
      parsed("<array><data><value><int>1</int></value><value><string>x</string></value></data></array>"),
      "[1, \"x\"]");
  EXPECT_EQ(parsed("<struct><member><name>a</name><value><int>1</int></value></member></struct>"),
            "struct(a=1)");
  EXPECT_FALSE(parse_xml_rpc_response("<methodResponse><params/></methodResponse>")->is(Type::pose));
}

TEST(XmlRpcTest, AListOfListsIsAMatrix)
{
  const std::string row =
      "<value><array><data><value><int>1</int></value><value><int>2</int></value></data></array></value>";
  const auto value = parse_xml_rpc_response(response("<array><data>" + row + row + "</data></array>"));
  ASSERT_TRUE(value);
  EXPECT_TRUE(value->is(Type::matrix));
  EXPECT_EQ(
      encoded(*value),
      encoded(*parse_xml_rpc_response(response(encoded(*value).substr(7, encoded(*value).size() - 15)))));
}

TEST(XmlRpcTest, ReportsFaultsAndMalformedResponses)
{
  const std::string fault =
      "<methodResponse><fault><value><struct><member><name>faultCode</name><value><int>1</int></value></"
      "member>"
      "<member><name>faultString</name><value><string>method \"x\" is not supported</string></value></member>"
      "</struct></value></fault></methodResponse>";
  EXPECT_EQ(parse_xml_rpc_response(fault).error(), "XML-RPC response: fault: method \"x\" is not supported");
  EXPECT_FALSE(parse_xml_rpc_response(""));
  EXPECT_FALSE(parse_xml_rpc_response("<methodResponse>"));
  EXPECT_FALSE(parse_xml_rpc_response("<html><body>404</body></html>"));
  EXPECT_NE(parsed("<int>many</int>").find("'many' is not a number"), std::string::npos);
  EXPECT_NE(parsed("<int>3000000000</int>").find("is not a number of its type"), std::string::npos);
  EXPECT_NE(parsed("<dateTime.iso8601>19980717T14:08:55</dateTime.iso8601>").find("URScript has no type"),
            std::string::npos);
}

TEST(XmlRpcTest, ALongListIsDecoded)
{
  std::string elements;
  for (int i = 0; i < 5000; ++i) {
    elements += "<value><int>" + std::to_string(i) + "</int></value>";
  }
  const auto value = parse_xml_rpc_response(response("<array><data>" + elements + "</data></array>"));
  ASSERT_TRUE(value) << value.error();
  EXPECT_EQ(value->list().size(), 5000U);
  EXPECT_EQ(value->list().back().integer(), 4999);
}

TEST(XmlRpcTest, DeepNestingIsRejected)
{
  std::string value = "<int>1</int>";
  for (int i = 0; i < 20; ++i) {
    value = "<array><data><value>" + value + "</value></data></array>";
  }
  EXPECT_NE(parsed(value).find("nested deeper"), std::string::npos);
}

/// A hostile server must not reach the depth at which a parser runs out of stack.
TEST(XmlRpcTest, ManyOpenTagsAreRejected)
{
  for (const char * tag : {"<value>", "<a>/>", "<a b='/>'>"}) {
    std::string tags;
    for (int i = 0; i < 150000; ++i) {
      tags += tag;
    }
    EXPECT_EQ(parse_xml_rpc_response(tags).error(), "XML-RPC response: XML_ELEMENT_DEPTH_EXCEEDED in line 1");
  }
}

TEST(XmlRpcTest, EntitiesAndCommentsArePartOfXml)
{
  EXPECT_EQ(parsed("<string>a &lt; b &amp; c</string>"), "a < b & c");
  EXPECT_EQ(parsed("<!-- five --><int>5</int>"), "5");
}

}  // namespace
}  // namespace ur_simulator
