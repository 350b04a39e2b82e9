poesy_test(schema_test LABELS unit SOURCES engine/schema/keys_test.cpp LINKS poesy_schema)
