#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "filters/catalogue.h"
#include "harness/run/options.h"

namespace shadowbench::cli {

// What commands share of reading their options. All throw Error(kUsage) with the option's name.

/// Parses a whole number, 1 or more.
int parse_count(const std::string& text, const char* option);

/// Parses the WIDTHxHEIGHT of `--size`, in pixels.
std::pair<int, int> parse_picture_size(const std::string& text);

/// Parses the AZIMUTH,ELEVATION of `--light`, in degrees.
run::LightAngles parse_light(const std::string& text);

/// Names the built-in scenes.
std::vector<std::string> list_builtin_scenes(const run::Resources& resources);

/// Refuses filters that are named twice with the same parameters.
void require_distinct(const std::vector<filters::FilterRequest>& requests);

/// Gives the folder for traced images; empty: nothing is kept.
std::filesystem::path choose_cache(const std::string& folder, bool no_cache);

}  // namespace shadowbench::cli
