// What check_mirror is to find: there is nothing that this could test.
