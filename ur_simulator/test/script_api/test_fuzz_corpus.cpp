#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size);

namespace {

// Seeds and inputs that once crashed the compiler or the interpreter. The fuzz target runs them without
// fuzzing.
TEST(UrscriptFuzzCorpusTest, EveryInputRuns)
{
  int inputs = 0;
  for (const auto & entry : std::filesystem::directory_iterator(URSCRIPT_FUZZ_CORPUS)) {
    SCOPED_TRACE(entry.path().filename().string());
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string input{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    EXPECT_EQ(LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t *>(input.data()), input.size()), 0);
    ++inputs;
  }
  EXPECT_GE(inputs, 5);
}

}  // namespace
