#include "morphbake/cache/content_hash.h"

#include <fmt/core.h>

#define XXH_INLINE_ALL
#include <link.h>
#include <xxhash.h>

#include <cstddef>
#include <fstream>
#include <memory>
#include <vector>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

/// A hash that is fed piece by piece.
class Hasher {
 public:
  Hasher() { XXH3_128bits_reset(state_.get()); }

  void add(const void* bytes, std::size_t count) {
    XXH3_128bits_update(state_.get(), bytes, count);
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

/// Hashes the constant parts of the loaded object that holds this function, then stops.
int hash_own_object(dl_phdr_info* object, std::size_t, void* hasher) {
  const auto own = reinterpret_cast<ElfW(Addr)>(&hash_own_object);
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
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader gives addresses as numbers
    const void* begin = reinterpret_cast<const void*>(object->dlpi_addr + part.p_vaddr);
    static_cast<Hasher*>(hasher)->add(begin, part.p_filesz);
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
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> piece(kPiece);
  Hasher hasher;
  while (stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    hasher.add(piece.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.eof()) fail("files.unreadable", file, "cannot read the file");
  return hasher.digits();
}

const std::string& FileHashes::of(const fs::path& file) {
  const auto found = hashes_.find(file);
  if (found != hashes_.end()) return found->second;
  return hashes_.emplace(file, file_hash(file)).first->second;
}

const std::string& program_hash() {
  static const std::string hash = [] {
    Hasher hasher;
    dl_iterate_phdr(hash_own_object, &hasher);
    return hasher.digits();
  }();
  return hash;
}

}  // namespace morphbake
