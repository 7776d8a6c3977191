#include "base/text_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "base/file_kind.h"
#include "base/read_files.h"
#include "base/utf8.h"

namespace hydro {
std::string ReadTextFile(const std::string& file) {
  constexpr size_t kLargest = 64u << 20;
  CheckIsFile(file);
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw InputError(file + ": cannot be read: " + std::strerror(errno) +
                     (errno == EMFILE   ? "; a larger limit (ulimit -n) is needed"
                      : errno == ENOENT ? "; is its path right?"
                                        : ""));
  }
  std::string text;
  char block[65536];
  while (stream.read(block, sizeof block), stream.gcount() > 0) {
    text.append(block, static_cast<size_t>(stream.gcount()));
    if (text.size() > kLargest) {
      const std::optional<FileKind> kind = FindFileKind(std::string_view(text).substr(0, sizeof block));
      throw InputError(
          file + ": " +
          (kind.has_value() ? OtherKind(*kind, file, "a text") : "found more than 64 MiB, allowed: 64 MiB"));
    }
  }
  if (stream.bad()) throw InputError(file + ": cannot be read: " + std::strerror(errno));
  RememberRead(file);
  return text;
}

void CheckIsFile(const std::string& file) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  const bool folder = std::filesystem::is_directory(status);
  // Opening a pipe that has no writer waits forever.
  if (folder || std::filesystem::is_fifo(status) || std::filesystem::is_socket(status)) {
    throw InputError(file + ": found a " + (folder ? "folder" : "pipe") + ", allowed: a file");
  }
  CheckIsNoDevice(file);
}

void CheckIsNoDevice(const std::string& file) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (!std::filesystem::is_character_file(status) && !std::filesystem::is_block_file(status)) return;
  throw InputError(file + ": found a device, allowed: a file");
}

std::string PathBeside(const std::string& beside, const std::string& file) {
  return (std::filesystem::path(beside).parent_path() / file).lexically_normal().string();
}

std::string Quoted(std::string_view text) {
  constexpr size_t kLongest = 200;
  std::string quoted = "\"";
  for (size_t i = 0; i < text.size(); ++i) {
    if (text.size() > kLongest && i == kLongest / 2) {
      quoted += " ... ";
      i = text.size() - kLongest / 2;
    }
    const unsigned char c = static_cast<unsigned char>(text[i]);
    if (c == '\n') {
      quoted += "\\n";
    } else if (c == '\t') {
      quoted += "\\t";
    } else if (c < 0x20 || c == 0x7f) {
      char code[8];
      std::snprintf(code, sizeof code, "\\x%02x", c);
      quoted += code;
    } else {
      quoted += static_cast<char>(c);
    }
  }
  return quoted + "\"";
}

std::string Printable(std::string_view text) {
  std::string printable;
  printable.reserve(text.size());
  while (!text.empty()) {
    size_t length = CharacterLength(text);
    const unsigned char c = static_cast<unsigned char>(text[0]);
    const bool control = length == 1 && ((c < 0x20 && c != '\t') || c == 0x7f);
    // U+0080 to U+009F are the same commands as ESC and a letter.
    const bool long_control = length == 2 && c == 0xc2 && static_cast<unsigned char>(text[1]) < 0xa0;
    if (length == 0 || control || long_control) {
      length = std::max<size_t>(length, 1);
      for (const char byte : text.substr(0, length)) {
        char code[8];
        std::snprintf(code, sizeof code, "\\x%02x", static_cast<unsigned char>(byte));
        printable += code;
      }
    } else {
      printable += text.substr(0, length);
    }
    text.remove_prefix(length);
  }
  return printable;
}

std::string PrintableLines(std::string_view text) {
  std::string printable;
  for (size_t end = 0; !text.empty(); text.remove_prefix(end)) {
    end = std::min(text.find('\n'), text.size());
    printable += Printable(text.substr(0, end));
    if (end == text.size()) continue;
    printable += '\n';
    ++end;
  }
  return printable;
}

}  // namespace hydro
