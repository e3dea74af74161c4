/*+++
[paramҕlogus]
+++*/
