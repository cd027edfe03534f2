// io/json_places.hpp: maps the elements of a model to their places in the file, for errors that are found later.
//
// The model knows nothing of files.  An error in it throws an InputError about a path of the model (InputError::of); the caller that has both
// completes the message: "scene.json:4:5: /solids/0/moves/2: expected ..."
#pragma once
#include "core/error.hpp"
#include "io/json.hpp"

#include <map>
#include <string>
#include <string_view>

namespace toile::internal {

class JsonPlaces {
 public:
  // The element at `path` of the model was read from this value; messages append `note` to its pointer.
  void add(std::string path, const Json& value, std::string_view note = {});
  // For a model whose paths are the pointers of its file.
  void add(const Json& value) { add(value.pointer(), value); }

  // The error with its place in the file, if the file has it; otherwise the error itself.  A place that begins with a slash is appended.
  InputError complete(const InputError& error) const;

  // Runs `work`; errors that it throws are completed.
  template <class Work>
  decltype(auto) complete_errors_of(const Work& work) const {
    try {
      return work();
    } catch (const InputError& error) {
      if (error.path().empty()) throw;
      throw complete(error);
    }
  }

 private:
  struct Place {
    std::string where, pointer;
  };
  std::map<std::string, Place, std::less<>> place_of_;
};

}  // namespace toile::internal
