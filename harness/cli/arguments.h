#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "filters/base/split_list.h"
#include "filters/catalogue.h"
#include "harness/options/options.h"

namespace shadowbench::cli {

// What commands share of reading their options. All but find_results() throw Error(kUsage) with the option's name.

/// Refuses what the command line says.
[[noreturn]] void fail(const std::string& message);

/// Parses a whole number, 1 or more.
int parse_count(const std::string& text, const char* option);

/// Parses the WIDTHxHEIGHT of `--size`, in pixels.
std::pair<int, int> parse_picture_size(const std::string& text);

/// Parses the AZIMUTH,ELEVATION of `--light`, in degrees.
options::LightAngles parse_light(const std::string& text);

/// Names the built-in scenes.
std::vector<std::string> list_builtin_scenes(const options::Resources& resources);

/// Refuses filters that are named twice with the same parameters.
void require_distinct(const std::vector<filters::FilterRequest>& requests);

/// Gives the results.json of a run, which is named by its folder or by that file. Throws Error(kInput) where there is
/// neither.
std::filesystem::path find_results(const std::filesystem::path& run);

/// Gives the folder for traced images; empty: nothing is kept.
std::filesystem::path choose_cache(const std::string& folder, bool no_cache);

}  // namespace shadowbench::cli
