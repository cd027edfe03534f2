// tests/support/message_of.hpp: the message of an error.
#pragma once
#include <gtest/gtest.h>

#include <string>

namespace toile::test {

// The message of the E that `work` throws; a failure if it throws none.
template <class E, class Work>
std::string message_of(const Work& work) {
  try {
    work();
  } catch (const E& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing of this kind was thrown";
  return "";
}

}  // namespace toile::test
