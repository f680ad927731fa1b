#include "morphbake/cache/content_hash.h"

#include <fmt/core.h>

#define XXH_INLINE_ALL
#include <link.h>
#include <xxhash.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

/// A hash that is fed piece by piece.
class Hasher {
 public:
  Hasher() { XXH3_128bits_reset(state_.get()); }

  /// What is left of a stream, or its next `most` bytes.
  /// @return  whether all could be read
  bool add(std::istream& stream, std::size_t most = std::numeric_limits<std::size_t>::max()) {
    constexpr std::size_t kPiece = std::size_t{1} << 20;
    std::vector<char> piece(std::min(most, kPiece));
    while (most > 0 && stream) {
      stream.read(piece.data(), static_cast<std::streamsize>(std::min(most, piece.size())));
      const auto count = static_cast<std::size_t>(stream.gcount());
      XXH3_128bits_update(state_.get(), piece.data(), count);
      most -= count;
    }
    return most == 0 || stream.eof();
  }

  std::string digits() const { return digits_of(XXH3_128bits_digest(state_.get())); }

  static std::string digits_of(const XXH128_hash_t& hash) {
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };

  std::unique_ptr<XXH3_state_t, Free> state_{XXH3_createState()};
};

[[noreturn]] void fail(const char* code, const fs::path& file, const std::string& message) {
  throw BakeError(Problem{Severity::Error, code, {file.string(), "", 0, 0}, message, ""});
}

/// Whether a part of a loaded object holds what no process changes.
bool is_constant(const ElfW(Phdr) & part) {
  return part.p_type == PT_LOAD && (part.p_flags & PF_W) == 0;
}

/// Constant parts of a loaded object: where they begin, and how many bytes they have.
using ConstantParts = std::vector<std::pair<ElfW(Addr), std::size_t>>;

/// Finds those of the object that holds this function, then stops.
int find_own_parts(dl_phdr_info* object, std::size_t, void* found) {
  const auto own = reinterpret_cast<ElfW(Addr)>(&find_own_parts);
  bool is_own = false;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = object->dlpi_phdr[i];
    const ElfW(Addr) begin = object->dlpi_addr + part.p_vaddr;
    is_own = is_own || (part.p_type == PT_LOAD && own >= begin && own < begin + part.p_memsz);
  }
  if (!is_own) return 0;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = object->dlpi_phdr[i];
    if (!is_constant(part)) continue;
    static_cast<ConstantParts*>(found)->push_back(
        {object->dlpi_addr + part.p_vaddr, part.p_filesz});
  }
  return 1;
}

}  // namespace

std::string content_hash(std::string_view bytes) {
  return Hasher::digits_of(XXH3_128bits(bytes.data(), bytes.size()));
}

std::string file_hash(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) fail("files.missing", file, "there is no such file");
  if (!fs::is_regular_file(status)) {
    fail("files.not-a-file", file, "this is not a regular file");
  }
  std::ifstream stream(file, std::ios::binary);
  Hasher hasher;
  if (!hasher.add(stream)) fail("files.unreadable", file, "cannot read the file");
  return hasher.digits();
}

const std::string& FileHashes::of(const fs::path& file) {
  const auto found = hashes_.find(file);
  if (found != hashes_.end()) return found->second;
  return hashes_.emplace(file, file_hash(file)).first->second;
}

const std::string& program_hash() {
  static const std::string hash = [] {
    ConstantParts own;
    dl_iterate_phdr(find_own_parts, &own);
    // As a file: sanitizers let no program read between its own variables.
    std::ifstream memory("/proc/self/mem", std::ios::binary);
    Hasher hasher;
    for (const auto& [begin, count] : own) {
      memory.seekg(static_cast<std::streamoff>(begin));
      if (!hasher.add(memory, count)) {
        fail("files.unreadable", "/proc/self/mem", "cannot read the program's own code");
      }
    }
    return hasher.digits();
  }();
  return hash;
}

}  // namespace morphbake
