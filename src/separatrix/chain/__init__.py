"""The chain of the paper, a module a stage; `solution` goes through them from a study to its cage."""
