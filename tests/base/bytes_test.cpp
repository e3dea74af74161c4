// Names of content: other bytes, another order or other pieces give another name, in both of its halves.

#include "base/bytes.h"

#include <gtest/gtest.h>

#include <vector>

namespace shadowbench {
namespace {

std::string name_of(const std::vector<std::string>& pieces) {
  ContentHash hash;
  for (const std::string& piece : pieces) hash.add(piece);
  return hash.name();
}

TEST(ContentHash, TellsBytesOrderAndPiecesApart) {
  const std::string name = name_of({"ab", "c"});
  EXPECT_EQ(name, "6e1b98b34d6a4beea73fdbfc1a855115");  // caches and keys of before hold such names
  EXPECT_EQ(name_of({"ab", "c"}), name);
  for (const std::vector<std::string>& other : {std::vector<std::string>{"ab", "d"},
                                                {"bb", "c"},
                                                {"a", "bc"},
                                                {"abc"},
                                                {"c", "ab"},
                                                {"ab", "c", ""},
                                                {"", "ab", "c"},
                                                {"ab"},
                                                {}}) {
    EXPECT_NE(name_of(other).substr(0, 16), name.substr(0, 16));
    EXPECT_NE(name_of(other).substr(16), name.substr(16));
  }
}

}  // namespace
}  // namespace shadowbench
