"""Rolling contact of two layered half-spaces in three dimensions, with partial slip."""
