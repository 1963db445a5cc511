// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>

namespace opponens::report {
namespace {

std::string to_text(double value, std::chars_format format, int precision) {
  std::array<char, 400> buffer;  // the largest double has 309 digits before the point
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format, precision).ptr;
  return {buffer.data(), end};
}

bool is_zero(const std::string& number) { return number.find_first_not_of("-0.") == std::string::npos; }

/// A row of Unicode 15's table 3-7: first bytes, range of the second byte, length. Later bytes are 80 to BF.
struct Sequence {
  unsigned first_low, first_high, second_low, second_high;
  std::size_t length;
};
constexpr std::array<Sequence, 8> kSequences{{{0xC2, 0xDF, 0x80, 0xBF, 2},
                                              {0xE0, 0xE0, 0xA0, 0xBF, 3},
                                              {0xE1, 0xEC, 0x80, 0xBF, 3},
                                              {0xED, 0xED, 0x80, 0x9F, 3},
                                              {0xEE, 0xEF, 0x80, 0xBF, 3},
                                              {0xF0, 0xF0, 0x90, 0xBF, 4},
                                              {0xF1, 0xF3, 0x80, 0xBF, 4},
                                              {0xF4, 0xF4, 0x80, 0x8F, 4}}};

bool between(unsigned value, unsigned low, unsigned high) { return value >= low && value <= high; }

/// Length of the well-formed UTF-8 sequence at the start of text, 0 when there is none.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  if (byte(0) < 0x80) return 1;
  for (const auto& row : kSequences) {
    if (!between(byte(0), row.first_low, row.first_high)) continue;
    bool well_formed = between(byte(1), row.second_low, row.second_high);
    for (std::size_t i = 2; i < row.length; ++i) well_formed = well_formed && between(byte(i), 0x80, 0xBF);
    return well_formed ? row.length : 0;
  }
  return 0;
}

void append_escaped(std::string& out, char c) {
  switch (c) {
    case '&':
      out += "&amp;";
      return;
    case '<':
      out += "&lt;";
      return;
    case '>':
      out += "&gt;";
      return;
    case '"':
      out += "&quot;";
      return;
    case '\'':
      out += "&#39;";
      return;
    default:
      break;
  }
  const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
  out += control && c != '\n' && c != '\t' ? ' ' : c;
}

}  // namespace

std::string concat(std::initializer_list<std::string_view> pieces) {
  std::string out;
  for (const auto piece : pieces) out += piece;
  return out;
}

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "n/a";
  std::string number = to_text(value, std::chars_format::fixed, decimals);
  if (number.front() == '-' && is_zero(number)) number.erase(0, 1);
  return number;
}

std::string compact(double value, int decimals) {
  std::string number = fixed(value, decimals);
  if (number.find('.') == std::string::npos) return number;
  number.erase(number.find_last_not_of('0') + 1);
  if (number.back() == '.') number.pop_back();
  return number;
}

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return "n/a";
  if (value == 0.0) return "0";
  // The exponent after rounding: 0.9996 to three digits is 1.00, not 1.000.
  const std::string scientific = to_text(value, std::chars_format::scientific, digits - 1);
  const std::size_t mark = scientific.find('e');
  int exponent = 0;
  const char* first = scientific.data() + mark + (scientific[mark + 1] == '+' ? 2 : 1);
  std::from_chars(first, scientific.data() + scientific.size(), exponent);
  if (exponent >= -4 && exponent < 7) return fixed(value, std::max(0, digits - 1 - exponent));
  return concat({scientific.substr(0, mark), "e", std::to_string(exponent)});
}

std::string percent(double fraction, int decimals) {
  const std::string number = fixed(100.0 * fraction, decimals);
  return number == "n/a" ? number : concat({number, " %"});
}

std::string grouped(long long value) {
  std::string number = std::to_string(value);
  const std::size_t first = value < 0 ? 1 : 0;
  for (std::size_t at = number.size(); at > first + 3;) {
    at -= 3;
    number.insert(at, "\u202F");
  }
  return number;
}

std::string escape(std::string_view text) {
  std::string out;
  out.reserve(text.size() + text.size() / 8);
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    if (length == 0) {
      out += "\uFFFD";
    } else if (length == 1) {
      append_escaped(out, text.front());
    } else {
      out += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return out;
}

std::string shortened(std::string_view id) { return std::string(id.substr(0, 12)); }

}  // namespace opponens::report
