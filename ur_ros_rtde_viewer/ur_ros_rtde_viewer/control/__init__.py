"""Commands from the page. Nothing outside this package moves an arm, and it is imported only with --control."""
