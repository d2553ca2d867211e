"""Pictures drawn by hand: marks on a sheet that become SVG of a page, a file of their own, or a figure of matplotlib."""
