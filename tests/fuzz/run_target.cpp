// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a target over its corpus, and then over mutations of it that a seed decides, in processes of their
// own: an input that crashes one, keeps it busy for 20 s or takes a GiB of memory is written down and named.
//   fuzz_obj CORPUS... [--executions N] [--seconds S] [--seed K]
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>

#include "fuzz_target.h"
#include "mutate_bytes.h"

namespace opaline::fuzz {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kBatch = 2000;         // inputs of one process
constexpr std::size_t kLongest = 1 << 22;    // bytes of an input
constexpr rlim_t kMemory = rlim_t(1) << 30;  // of a process, beyond what it has at its start
constexpr int kSeconds = 20;                 // of CPU for one input

struct Options {
  std::vector<std::string> corpus;
  std::size_t executions = 20000;
  double seconds = 1e9;
  std::uint64_t seed = 1;
};

/// Outlives the process that works on it.
struct Current {
  std::size_t executions, size;
  char bytes[kLongest];
};

Options options_of(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool has_value = i + 1 < argc;
    if (word == "--executions" && has_value)
      options.executions = std::stoull(argv[++i]);
    else if (word == "--seconds" && has_value)
      options.seconds = std::stod(argv[++i]);
    else if (word == "--seed" && has_value)
      options.seed = std::stoull(argv[++i]);
    else
      options.corpus.push_back(word);
  }
  return options;
}

/// Sorted by name, so that a seed means the same everywhere.
std::vector<std::string> corpus_of(const Options& options) {
  std::vector<std::string> inputs = seeds();
  std::vector<std::filesystem::path> files;
  for (const std::string& name : options.corpus) {
    if (!std::filesystem::is_directory(name)) {
      files.push_back(name);
      continue;
    }
    for (const auto& file : std::filesystem::directory_iterator(name)) files.push_back(file.path());
  }
  std::ranges::sort(files);
  for (const auto& file : files) inputs.push_back(file_bytes(file));
  return inputs;
}

#if defined(__SANITIZE_ADDRESS__)
void bound_memory() {}  // it needs more address space than any bound
#else
std::size_t virtual_bytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t pages = 0;
  file >> pages;
  return pages * std::size_t(::sysconf(_SC_PAGESIZE));
}

void bound_memory() {
  const rlimit bytes{virtual_bytes() + kMemory, virtual_bytes() + kMemory};
  ::setrlimit(RLIMIT_AS, &bytes);
}
#endif

}  // namespace

/// The error text of OpenImageIO's PNG callback leaks: libpng jumps past its destructor.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:ImageInput::geterror";
}

namespace {

void try_one(Current& current, const std::string& input) {
  current.size = std::min(input.size(), kLongest);
  std::memcpy(current.bytes, input.data(), current.size);
  const itimerval patience{{0, 0}, {kSeconds, 0}};
  ::setitimer(ITIMER_PROF, &patience, nullptr);  // its signal ends the process
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
  ++current.executions;
}

/// Batch 0 is the corpus itself.
void run_batch(const std::vector<std::string>& corpus, const Options& options, std::uint64_t batch,
               Clock::time_point end, Current& current) {
  bound_memory();
  if (batch == 0)
    for (const std::string& input : corpus) try_one(current, input);
  const std::vector<std::string> vocabulary = words();
  Random random(options.seed * 1000003 + batch);
  for (std::size_t i = 0; batch > 0 && i < kBatch && Clock::now() < end; ++i)
    try_one(current, mutated(corpus[below(random, corpus.size())], corpus[below(random, corpus.size())],
                             vocabulary, random));
}

int failure(const Current& current, int status) {
  const std::string path = "fuzz-finding-" + std::to_string(::getpid());
  std::ofstream(path, std::ios::binary).write(current.bytes, std::streamsize(current.size));
  std::fprintf(stderr, "%s by an input of %zu bytes, written to %s\n",
               WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : "ended", current.size, path.c_str());
  return 1;
}

int run(const Options& options) {
  void* const memory = ::mmap(nullptr, sizeof(Current), PROT_READ | PROT_WRITE,
                              MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  expect(memory != MAP_FAILED, "memory");
  Current& current = *static_cast<Current*>(memory);
  const std::vector<std::string> corpus = corpus_of(options);
  expect(!corpus.empty(), "a corpus");
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(std::min(options.seconds, 1e6)));
  for (std::uint64_t batch = 0; batch == 0 || (current.executions < options.executions && Clock::now() < end);
       ++batch) {
    const pid_t child = ::fork();
    if (child == 0) {
      run_batch(corpus, options, batch, end, current);
      std::exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    if (status != 0) return failure(current, status);
  }
  std::printf("%zu executions, nothing found\n", current.executions);
  return 0;
}

}  // namespace
}  // namespace opaline::fuzz

int main(int argc, char** argv) {
  // A library's threads share one arena: 64 MiB of address space for each would count as memory.
  ::mallopt(M_ARENA_MAX, 1);
  // No threads: they would not be there in the processes that are forked.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  return opaline::fuzz::run(opaline::fuzz::options_of(argc, argv));
}
