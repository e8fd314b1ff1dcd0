// What check_mirror is to find: nothing tests this.
