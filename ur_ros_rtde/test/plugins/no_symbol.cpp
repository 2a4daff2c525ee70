// A library that exports nothing.
namespace test {
int forgotten()
{
  return 1;
}
}  // namespace test
