#include "text.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace foreign_rig {

std::string Text(double value, const char* format) {
  if (!std::isfinite(value)) return "";
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string Number(double value) { return std::isfinite(value) ? Text(value, "%.6g") : "null"; }

std::string Float(double value) {
  const std::string text = Text(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string Quoted(const std::string& text) { return "\"" + text + "\""; }

std::ofstream Open(const std::string& file) {
  std::ofstream out(file);
  if (!out) throw std::runtime_error("cannot write " + file);
  return out;
}

}  // namespace foreign_rig
