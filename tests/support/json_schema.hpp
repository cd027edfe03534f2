// tests/support/json_schema.hpp: whether a schema allows a JSON value; only the keywords of draft 2020-12 that our schema uses.
// An unknown keyword fails the test.
#pragma once
#include "io/json.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <string_view>

namespace toile::internal::test {

class JsonSchema {
 public:
  explicit JsonSchema(const Json& root) : root_(&root) {}
  bool allows(const Json& value) const { return allows(*root_, value); }

 private:
  static bool is(std::string_view type, const Json& value) {
    if (type == "integer") return value.is_number() && value.number() == std::floor(value.number());
    return (type == "number" && value.is_number()) || (type == "string" && value.is_string()) ||
           (type == "boolean" && value.is_boolean()) || (type == "null" && value.is_null()) ||
           (type == "array" && value.is_array()) || (type == "object" && value.is_object());
  }
  const Json& referred(const std::string& reference) const {
    EXPECT_EQ(reference.rfind("#/$defs/", 0), 0U);
    return root_->at("$defs").at(reference.substr(8));
  }
  bool allows(const Json& schema, const Json& value) const {
    for (const auto& [word, said] : schema.object())
      if (!obeys(schema, word, said, value)) return false;
    return true;
  }
  bool obeys(const Json& schema, const std::string& word, const Json& said, const Json& value) const {
    static const std::set<std::string> words_for_people = {"$schema", "$defs", "title", "description", "default"};
    if (words_for_people.count(word) > 0) return true;
    if (word == "type") return is(said.string(), value);
    if (word == "$ref") return allows(referred(said.string()), value);
    if (word == "minimum") return !value.is_number() || value.number() >= said.number();
    if (word == "exclusiveMinimum") return !value.is_number() || value.number() > said.number();
    if (word == "maximum") return !value.is_number() || value.number() <= said.number();
    if (word == "minLength") return !value.is_string() || !value.string().empty();
    if (word == "minItems") return !value.is_array() || static_cast<double>(value.array().size()) >= said.number();
    if (word == "maxItems") return !value.is_array() || static_cast<double>(value.array().size()) <= said.number();
    if (word == "enum") {
      for (const Json& one : said.array())
        if (value.is_string() && one.string() == value.string()) return true;
      return false;
    }
    if (word == "not") return !allows(said, value);
    if (word == "allOf" || word == "anyOf" || word == "oneOf") {
      std::size_t count = 0;
      for (const Json& one : said.array())
        if (allows(one, value)) ++count;
      return word == "allOf" ? count == said.array().size() : word == "anyOf" ? count > 0 : count == 1;
    }
    if (word == "items" || word == "prefixItems") {
      if (!value.is_array()) return true;
      for (std::size_t k = 0; k < value.array().size(); ++k) {
        if (word == "prefixItems" && k >= said.array().size()) break;
        if (!allows(word == "items" ? said : said.array()[k], value.array()[k])) return false;
      }
      return true;
    }
    if (!value.is_object()) return true;
    if (word == "required") {
      for (const Json& key : said.array())
        if (value.find(key.string()) == nullptr) return false;
      return true;
    }
    const Json* known = schema.find("properties");
    for (const auto& [key, member] : value.object()) {
      const Json* of_key = known != nullptr ? known->find(key) : nullptr;
      if (word == "properties" && of_key != nullptr && !allows(*of_key, member)) return false;
      if (word != "additionalProperties" || of_key != nullptr) continue;
      if (said.is_boolean() ? !said.boolean() : !allows(said, member)) return false;
    }
    EXPECT_TRUE(word == "properties" || word == "additionalProperties") << "a word of schemas: " << word;
    return true;
  }

  const Json* root_;
};

}  // namespace toile::internal::test
