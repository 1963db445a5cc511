// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace opponens::report {

// Text of a report depends on its values only: no locale, no stream state, so equal input gives equal bytes.

/// The pieces one after another.
std::string concat(std::initializer_list<std::string_view> pieces);

/// value with a fixed number of decimals, '.' as decimal point, never "-0"; "n/a" when value is not finite.
std::string fixed(double value, int decimals);

/// The same without trailing zeros: coordinates of a drawing.
std::string compact(double value, int decimals = 1);

/// value with a number of significant digits; plain notation from 1e-4 to 1e7, else "1.2e-9". "n/a" when not finite.
std::string significant(double value, int digits = 3);

/// 100 * fraction with decimals and a percent sign.
std::string percent(double fraction, int decimals = 1);

/// Integer with thin groups of thousands: "12 345".
std::string grouped(long long value);

/// Text safe in HTML and SVG content and in quoted attributes: & < > " ' become entities, control characters spaces,
/// bytes that are not UTF-8 U+FFFD.
std::string escape(std::string_view text);

/// The first 12 characters of an id, as people quote it.
std::string shortened(std::string_view id);

/// Already safe markup. Only this module makes it; everything that comes from outside passes through text().
struct Markup {
  std::string html;
  Markup& operator+=(const Markup& other) {
    html += other.html;
    return *this;
  }
};
inline Markup text(std::string_view plain) { return {escape(plain)}; }

}  // namespace opponens::report
