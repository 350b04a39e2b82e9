poesy_test(schema_test LABELS unit SOURCES engine/schema/keys_given_test.cpp engine/schema/keys_test.cpp engine/schema/toml_text_test.cpp
           LINKS poesy_schema)
