#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

// Runs a fuzz target without libFuzzer, for compilers that lack it: all inputs of the corpus, then mutations
// of them, which are the same in each run.
//
// usage: replay_<target> <corpus folder> <number of mutations>
// Only a sixth of the mutations is run unless UR_TEST_THOROUGH is set (./ur test --thorough). An input that
// crashes the target is written to crash-<target>.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t * data, std::size_t size);

namespace {

constexpr std::size_t max_size = 4096;

std::string current_input;
std::string crash_file;

void save_current_input(int signal_number)
{
  if (std::FILE * file = std::fopen(crash_file.c_str(), "wb")) {
    std::fwrite(current_input.data(), 1, current_input.size(), file);
    std::fclose(file);
  }
  std::signal(signal_number, SIG_DFL);
  std::raise(signal_number);
}

void run(const std::string & input)
{
  current_input = input;
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t *>(input.data()), input.size());
}

std::vector<std::string> read_corpus(const std::filesystem::path & folder)
{
  std::vector<std::filesystem::path> paths;
  for (const auto & entry : std::filesystem::directory_iterator(folder)) {
    paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> corpus;
  for (const auto & path : paths) {
    std::ifstream file(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return corpus;
}

class Mutator {
 public:
  explicit Mutator(const std::vector<std::string> & corpus) : corpus_(corpus) {}

  std::string next()
  {
    std::string input = any_input();
    for (std::size_t count = 1 + below(4); count > 0; --count) {
      mutate(input);
    }
    input.resize(std::min(input.size(), max_size));
    return input;
  }

 private:
  std::size_t below(std::size_t limit) { return limit == 0 ? 0 : random_() % limit; }
  const std::string & any_input() { return corpus_[below(corpus_.size())]; }

  void mutate(std::string & input)
  {
    const std::size_t at = below(input.size());
    switch (below(6)) {
      case 0:  // change a byte
        if (!input.empty()) {
          input[at] = static_cast<char>(random_());
        }
        break;
      case 1:  // change a bit
        if (!input.empty()) {
          input[at] = static_cast<char>(static_cast<unsigned char>(input[at]) ^ (1U << below(8)));
        }
        break;
      case 2:
        input.erase(at, 1 + below(16));
        break;
      case 3:
        input.insert(at, 1 + below(16), static_cast<char>(random_()));
        break;
      case 4:  // repeat a part
        input.insert(below(input.size() + 1), input.substr(at, below(64)));
        break;
      default: {  // insert a part of another input
        const std::string & other = any_input();
        input.insert(at, other.substr(below(other.size()), below(256)));
      }
    }
  }

  const std::vector<std::string> & corpus_;
  std::mt19937 random_{1};
};

}  // namespace

int main(int argc, char ** argv)
{
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s <corpus folder> <number of mutations>\n", argv[0]);
    return 2;
  }
  crash_file = "crash-" + std::filesystem::path(argv[0]).filename().string();
  for (const int signal_number : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTERM}) {
    std::signal(signal_number, save_current_input);
  }
  const std::vector<std::string> corpus = read_corpus(argv[1]);
  if (corpus.empty()) {
    std::fprintf(stderr, "%s is empty\n", argv[1]);
    return 1;
  }
  for (const std::string & input : corpus) {
    run(input);
  }
  Mutator mutator(corpus);
  constexpr long share = 6;
  const bool is_thorough = std::getenv("UR_TEST_THOROUGH") != nullptr;
  const long mutations = std::strtol(argv[2], nullptr, 10) / (is_thorough ? 1 : share);
  for (long i = 0; i < mutations; ++i) {
    run(mutator.next());
  }
  std::printf("%zu inputs of the corpus, %ld mutations\n", corpus.size(), mutations);
  return 0;
}
