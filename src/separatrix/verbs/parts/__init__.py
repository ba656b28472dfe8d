"""What several verbs tell."""
