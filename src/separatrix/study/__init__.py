"""What is asked: bearing, film, cage, candidates, as records without a result; the library."""
