#include "morphbake/json/schema.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "morphbake/json/embedded.h"
#include "morphbake/json/explain.h"

namespace morphbake {
namespace {

const std::vector<std::string> names = {"recipe.schema.json", "landmarks.schema.json",
                                        "options.schema.json", "profile.schema.json"};

/// Calls `each(node, pointer)` for every sub-schema.
void for_each_node(const Json& node, const std::string& pointer,
                   const std::function<void(const Json&, const std::string&)>& each) {
  if (!node.is_object()) return;
  each(node, pointer);
  for (const char* map : {"properties", "definitions"}) {
    if (!node.contains(map)) continue;
    for (const auto& [name, child] : node[map].items()) {
      for_each_node(child, child_pointer(child_pointer(pointer, map), name), each);
    }
  }
  for (const char* keyword : {"items", "additionalProperties", "propertyNames"}) {
    if (node.contains(keyword)) for_each_node(node[keyword], child_pointer(pointer, keyword), each);
  }
}

TEST(Schemas, UseOnlyKeywordsThatAreExplained) {
  const std::set<std::string> known = {"$schema",
                                       "$ref",
                                       "title",
                                       "description",
                                       "examples",
                                       "default",
                                       "definitions",
                                       "type",
                                       "enum",
                                       "const",
                                       "minimum",
                                       "maximum",
                                       "exclusiveMinimum",
                                       "minLength",
                                       "maxLength",
                                       "pattern",
                                       "items",
                                       "minItems",
                                       "maxItems",
                                       "properties",
                                       "additionalProperties",
                                       "propertyNames",
                                       "required",
                                       "minProperties",
                                       "maxProperties",
                                       "x-problems",
                                       "x-unit",
                                       "x-form",
                                       "x-default"};
  for (const std::string& name : names) {
    for_each_node(shipped_schema(name), "", [&](const Json& node, const std::string& pointer) {
      for (const auto& [keyword, value] : node.items()) {
        EXPECT_TRUE(known.contains(keyword)) << name << "#" << pointer << " " << keyword;
      }
    });
  }
}

TEST(Schemas, PatternsHaveWords) {
  for (const std::string& name : names) {
    for_each_node(shipped_schema(name), "", [&](const Json& node, const std::string& pointer) {
      EXPECT_EQ(node.contains("pattern") && !node.contains("x-form"), false) << name << pointer;
    });
  }
}

void expect_documented(const Json& schema, const Json& object, const std::string& at) {
  const Json required = object.value("required", Json::array());
  for (const auto& [field, node] : object["properties"].items()) {
    const Json& target = referred(schema, node);
    std::string where = at;
    where.append("/").append(field);
    EXPECT_TRUE(node.contains("description") || target.contains("description")) << where;
    const bool is_required = std::find(required.begin(), required.end(), field) != required.end();
    const bool has_default = node.contains("default") || node.contains("x-default") ||
                             target.contains("default") || target.contains("x-default");
    EXPECT_TRUE(is_required || has_default || target.contains("const")) << where;
  }
}

TEST(Schemas, EveryFieldHasADescriptionAndADefaultUnlessRequired) {
  for (const std::string& name : names) {
    const Json schema = shipped_schema(name);
    for_each_node(schema, "", [&](const Json& node, const std::string& pointer) {
      if (node.contains("properties"))
        expect_documented(schema, node, std::string(name).append("#").append(pointer));
    });
  }
}

TEST(Schemas, EveryNumberHasARange) {
  for (const std::string& name : names) {
    for_each_node(shipped_schema(name), "", [&](const Json& node, const std::string& pointer) {
      const std::string type = node.value("type", Json("")).dump();
      if (type.find("number") == std::string::npos && type.find("integer") == std::string::npos) {
        return;
      }
      EXPECT_TRUE(node.contains("minimum") || node.contains("exclusiveMinimum")) << pointer;
      EXPECT_TRUE(node.contains("maximum")) << pointer;
    });
  }
}

/// A schema for one node of `schema`, so that the node's own examples can be checked.
Json alone(const Json& schema, const Json& node) {
  Json whole = node;
  if (schema.contains("definitions")) whole["definitions"] = schema["definitions"];
  return whole;
}

TEST(Schemas, ExamplesAndDefaultsAreValid) {
  for (const std::string& name : names) {
    const Json schema = shipped_schema(name);
    for_each_node(schema, "", [&](const Json& node, const std::string& pointer) {
      Json values = node.value("examples", Json::array());
      if (node.contains("default")) values.push_back(node["default"]);
      const Json target = alone(schema, referred(schema, node));
      for (const Json& value : values) {
        for (const Problem& problem : schema_problems(value, target, {name, pointer})) {
          ADD_FAILURE() << format_problem(problem);
        }
      }
    });
  }
}

TEST(SchemaProblems, ThreePointZeroIsAnInteger) {
  const Json schema = shipped_schema("options.schema.json");
  EXPECT_TRUE(schema_problems({{"turntable", {{"samples", 3.0}}}}, schema, {}).empty());
  EXPECT_FALSE(schema_problems({{"turntable", {{"samples", 3.5}}}}, schema, {}).empty());
}

TEST(SchemaProblems, ReportsWhatOnlyValijsonKnows) {
  const Json schema = {{"x-problems", "test"},
                       {"properties", {{"a", {{"not", {{"type", "string"}}}}}, {"b", false}}}};
  const auto problems = schema_problems({{"a", "text"}}, schema, {"file.json", "/below"});
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].location.pointer, "/below/a");
  EXPECT_EQ(problems[0].code, "test.bad-value");
  EXPECT_EQ(schema_problems({{"b", 1}}, schema, {"file.json", ""}).size(), 1U);
}

TEST(SchemaProblems, AreCutAtAHundred) {
  const Json document(std::vector<int>(100000, 1));
  const Json schema = {{"type", "array"}, {"items", {{"type", "string"}}}};
  EXPECT_EQ(schema_problems(document, schema, {}).size(), problems_limit);
}

TEST(SchemaProblems, TheLongestStringFitsThePatternMatchersStack) {
  const std::string longest(1024, 'x');
  const Json document = parse_json("{\"name\": \"" + longest + "\", \"states\": {\"" + longest +
                                       "\": {}}, \"outputs\": [{\"file\": \"" + longest + "\"}]}",
                                   "file.json");
  EXPECT_EQ(schema_problems(document, shipped_schema("recipe.schema.json"), {}).size(), 7U);
}

Json instructive_recipe() {
  return parse_json(R"({
    "version": 1, "name": "all", "units": "scene",
    "sources": {"a": "a.glb", "b": {"file": "b.glb", "landmarks": {"n": {"position": [0, 1, 2]}}}},
    "regions": {"r": {"ball": {"on": "a", "at": "n", "inner": 0, "outer": 1, "distance": "edges"}},
                "s": {"rest_of": ["r"]}},
    "states": {"x": {"mix": {"a": 0.5, "b": 0.5}, "edits": [{"region": "r", "to": "b", "amount": 1}]}},
    "timeline": {"fps": 30, "duration": 4, "start": "a", "tracks": [
      {"name": "t", "region": "r", "to": "b", "amount": 1, "begin": 0, "end": 1, "ease": "step"},
      {"region": "s", "to": {"b": 1}, "begin": {"after": "t", "delay": 1}, "duration": 1}]},
    "outputs": [{"file": "o.glb", "targets": "frames"}, {"file": "p.glb", "still": {"at": 1}}],
    "preview": {"turntable": {"size": [64, 64], "frames": 5}, "formats": ["png"]},
    "options": {"basis": {"easing_tolerance": 1e-5}}})",
                    "all");
}

/// Calls `each(document)` with every value of `node` replaced by every one of a few, one at a time.
void for_each_mutation(Json& document, Json& node, const std::function<void(const Json&)>& each) {
  const Json keep = node;
  for (const char* text : {"null", "-1", "1e300", "\"a:b\"", "[1, 1]", "{}", "{\"a:\": 1}"}) {
    node = Json::parse(text);
    each(document);
    node = keep;
  }
  if (node.is_object()) {
    for (const auto& [key, value] : keep.items()) {
      node.erase(key);
      each(document);
      node = keep;
    }
    node["other"] = 1;
    each(document);
    node = keep;
  }
  if (!node.is_structured()) return;
  for (Json& child : node) for_each_mutation(document, child, each);
}

TEST(SchemaProblems, WordsAndValijsonAgreeOnEveryMutation) {
  const Json schema = shipped_schema("recipe.schema.json");
  Json document = instructive_recipe();
  ASSERT_TRUE(schema_problems(document, schema, {}).empty());
  int invalid = 0;
  for_each_mutation(document, document, [&](const Json& mutation) {
    const auto explained = explain(mutation, schema, {});
    const auto problems = schema_problems(mutation, schema, {});
    EXPECT_EQ(explained.size(), problems.size()) << mutation.dump();
    invalid += problems.empty() ? 0 : 1;
  });
  EXPECT_GT(invalid, 300);
}

}  // namespace
}  // namespace morphbake
