// The library is made of the rooms; a target needs one source of its own.
