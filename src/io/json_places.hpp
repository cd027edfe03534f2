// io/json_places.hpp: where in a file that stands of which a model was made: beside the model, for what is found wrong with it later.
//
// The model knows nothing of files.  What is found in it throws an InputError about a path of it (InputError::of); whoever has both completes
// the message: "scene.json:4:5: /solids/0/moves/2: expected ..."
#pragma once
#include "core/error.hpp"
#include "io/json.hpp"

#include <map>
#include <string>
#include <string_view>

namespace toile::internal {

class JsonPlaces {
 public:
  // What is at `path` of the model was read from this value; messages say `note` behind its pointer.
  void add(std::string path, const Json& value, std::string_view note = {});
  // Of a model whose paths are the pointers of its file.
  void add(const Json& value) { add(value.pointer(), value); }

  // The same where the file says of what the error is about; otherwise the error.  A place that begins with a slash goes on from there.
  InputError complete(const InputError& error) const;

  // What the work throws is complete.
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
