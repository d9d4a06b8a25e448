"""Files that libraries read: each in a process of its own, which may fail without harm."""
