#include "io/json_places.hpp"

#include <gtest/gtest.h>

#include <string>

namespace toile::internal {
namespace {

const char* const text = "{\"pins\": [{},\n  {\"moves\": []}]}";

template <class Work>
std::string message(const JsonPlaces& places, const Work& work) {
  try {
    places.complete_errors_of(work);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no error)";
}

TEST(JsonPlaces, CompleteWhatIsAboutSomethingThatTheyKnow) {
  const Json root = Json::parse(text, "s.json");
  JsonPlaces places;
  places.add(root.at("pins").array()[1]);
  const auto thrown = [&](const InputError& error) { return message(places, [&] { throw InputError(error); }); };
  EXPECT_EQ(thrown(InputError("", "/moves/2", "a", "b").of("/pins/1")),
            "s.json:2:3: /pins/1/moves/2: expected a, got b");
  EXPECT_EQ(thrown(InputError("", "edge_m", "a", "b").of("/pins/1")), "s.json:2:3: /pins/1: edge_m: expected a, got b");
  EXPECT_EQ(thrown(InputError("pin 1", "", "a", "b").of("/pins/1")), "s.json:2:3: /pins/1: expected a, got b");
  EXPECT_EQ(thrown(InputError("pin 0", "", "a", "b").of("/pins/0")), "pin 0: expected a, got b") << "not known";
  EXPECT_EQ(thrown(InputError("p.json:1:1", "/x", "a", "b")), "p.json:1:1: /x: expected a, got b") << "complete";
}

TEST(JsonPlaces, MayBeKnownByAnotherPathAndHaveANote) {
  const Json root = Json::parse(text, "p.json");
  JsonPlaces places;
  places.add("/model/a", root.at("pins").array()[0], " (pin a)");
  EXPECT_STREQ(places.complete(InputError("pin a", "", "a", "b").of("/model/a")).what(),
               "p.json:1:11: /pins/0 (pin a): expected a, got b");
}

TEST(JsonPlaces, LetResultsAndOtherErrorsThrough) {
  const JsonPlaces places;
  EXPECT_EQ(places.complete_errors_of([] { return 7; }), 7);
  EXPECT_THROW(places.complete_errors_of([] { throw IoError("a", "b"); }), IoError);
}

}  // namespace
}  // namespace toile::internal
