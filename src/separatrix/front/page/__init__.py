"""The local page: studies of a folder, edited, run and looked at in a browser on this machine."""
