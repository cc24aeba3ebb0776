# Tests of the room in this file's name.
