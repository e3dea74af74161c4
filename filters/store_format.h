#pragma once

#include <string>
#include <vector>

#include "filters/scalar.h"

namespace shadowbench::filters {

/// How an encoded map keeps its numbers.
enum class StorePrecision { kSingle, kHalf, kUnorm16 };

/// Reads the precision from a format's name, such as "rg16f".
StorePrecision store_precision(const std::string& format);

/// The formats that a pass of a filter's own may write; those with `ui` hold whole numbers of 32 bits.
const std::vector<std::string>& pass_formats();

/// The formats that encode() may write.
const std::vector<std::string>& encode_formats();

/// The channels of a format's name, 1, 2 or 4.
int store_channels(const std::string& format);

/// The bytes of one texel of a format.
int store_bytes(const std::string& format);

/// The largest number that a precision holds: 65504 for half floats.
double largest_number(StorePrecision precision);

/// Rounds a value as the store does. Values of type double and wider are references and stay as they are.
float round_to_store(float value, StorePrecision precision);
inline double round_to_store(double value, StorePrecision) { return value; }
inline long double round_to_store(long double value, StorePrecision) { return value; }
Tracked round_to_store(Tracked value, StorePrecision precision);

}  // namespace shadowbench::filters
